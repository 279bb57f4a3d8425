// Erosion and dilation are those of OpenCV, whatever the size of the brush.
#include "image/brush.hpp"

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

class Brush : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static int half() { return GetParam(); }
  [[nodiscard]] static cv::Mat square() {
    return cv::Mat::ones(2 * half() + 1, 2 * half() + 1, CV_8U);
  }
};

TEST_P(Brush, ErodesBySquaresAndTakesTheOutsideForEmpty) {
  for (std::uint64_t number = 0; number < 35; ++number) {
    const cv::Mat mask = some_mask(number);
    cv::Mat expected;
    cv::erode(mask, expected, square(), {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    const Mask own = eroded(mat::image_of<std::uint8_t>(mask), half());
    ASSERT_TRUE(same_bits(mat::mat_over(own), expected)) << number;
  }
}

TEST_P(Brush, DilatesBySquares) {
  for (std::uint64_t number = 0; number < 35; ++number) {
    const cv::Mat mask = some_mask(number);
    cv::Mat expected;
    cv::dilate(mask, expected, square());
    const Mask own = dilated(mat::image_of<std::uint8_t>(mask), half());
    ASSERT_TRUE(same_bits(mat::mat_over(own), expected)) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Brush, testing::Values(0, 1, 2, 3, 4, 7, 8, 15, 16, 17, 40));

TEST(Brush, LeavesTheMaskThatItIsGiven) {
  const cv::Mat mask = some_mask(1);
  const cv::Mat before = mask.clone();
  Mask none = eroded(mat::image_of<std::uint8_t>(mask), 0);
  const Mask some = dilated(mat::image_of<std::uint8_t>(mask), 3);
  none.fill(7);
  EXPECT_TRUE(same_bits(mask, before));
}

}  // namespace
}  // namespace flowdlo::image
