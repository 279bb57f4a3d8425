// Distances have the bits of OpenCV's.
#include "image/distance.hpp"

#include <algorithm>
#include <vector>

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

TEST(Distance, HasTheBitsOfOpenCv) {
  for (std::uint64_t number = 0; number < 210; ++number) {
    const cv::Mat mask = some_mask(number);
    cv::Mat expected;
    cv::distanceTransform(mask, expected, cv::DIST_L2, 5);
    const auto own = distance_to_empty(mat::image_of<std::uint8_t>(mask));
    ASSERT_TRUE(same_bits(mat::mat_over(own), expected)) << number;
  }
}

TEST(Distance, OfAPartIsThatOfACopy) {
  const cv::Mat mask = some_mask(8);
  const Mask whole = mat::image_of<std::uint8_t>(mask);
  const Mask part = whole.part({1, 1, whole.width() - 2, whole.height() - 2});
  EXPECT_TRUE(same_bits(mat::mat_of(distance_to_empty(part)),
                        mat::mat_of(distance_to_empty(part.clone()))));
}

TEST(Distance, OfNothingIsNothing) { EXPECT_TRUE(distance_to_empty(Mask()).empty()); }

TEST(Ridges, AreTheMiddleOfAStroke) {
  Mask mask({12, 9}, 0);
  for (int v = 2; v <= 6; ++v) {
    for (int u = 1; u <= 10; ++u) mask.at(v, u) = 1;
  }
  std::vector<float> ridge;
  for_ridges(distance_to_empty(mask), [&](float d) { ridge.push_back(d); });
  ASSERT_FALSE(ridge.empty());
  EXPECT_EQ(*std::max_element(ridge.begin(), ridge.end()), 3);
  EXPECT_EQ(std::count(ridge.begin(), ridge.end(), 3.0F), 6) << "three pixels from either end on";
}

TEST(Ridges, OfNothingAreNone) {
  for_ridges(distance_to_empty(Mask({6, 5}, 0)), [](float) { FAIL(); });
}

}  // namespace
}  // namespace flowdlo::image
