// Distances have the bits of OpenCV's.
#include "image/distance.hpp"

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

}  // namespace
}  // namespace flowdlo::image
