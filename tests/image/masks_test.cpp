// What is asked of masks, beside OpenCV's answers.
#include "image/masks.hpp"

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

TEST(Masks, AreCountedAsOpenCvCountsThem) {
  for (std::uint64_t number = 0; number < 70; ++number) {
    const cv::Mat mask = some_mask(number);
    const Mask own = mat::image_of<std::uint8_t>(mask);
    EXPECT_EQ(count_set(own), cv::countNonZero(mask));
  }
}

TEST(Masks, TheMajorityIsOpenCvsBoxFilterOfValuesUpTo255) {
  for (const int side : {3, 5, 7, 13, 21}) {
    for (std::uint64_t number = 0; number < 70; ++number) {
      const cv::Mat mask = some_mask(number);
      cv::Mat share = 255 * mask;
      cv::boxFilter(share, share, CV_8U, {side, side}, {-1, -1}, true, cv::BORDER_CONSTANT);
      const cv::Mat expected = (share > 127) / 255;
      const Mask own = majority(mat::image_of<std::uint8_t>(mask), side);
      ASSERT_TRUE(same_bits(mat::mat_over(own), expected)) << number << ", side " << side;
    }
  }
}

TEST(Masks, AreComparedAndTurnedOverPixelByPixel) {
  const cv::Mat a = some_values({40, 30}, CV_8U, 1);
  const Mask own_a = mat::image_of<std::uint8_t>(a);
  const Mask high = above(own_a, 127, 1);
  EXPECT_TRUE(same_bits(mat::mat_over(high), (a > 127) / 255));
  EXPECT_TRUE(same_bits(mat::mat_of(inverse(high)), (a <= 127) / 255));
  EXPECT_TRUE(same(high, above(own_a, 127, 255)));
  EXPECT_FALSE(same(high, inverse(high)));
}

}  // namespace
}  // namespace flowdlo::image
