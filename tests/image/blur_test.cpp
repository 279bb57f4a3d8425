// A Gaussian has the bits of OpenCV's, where both may use the same instructions: on x86 with AVX2
// and FMA, and on ARM. Elsewhere OpenCV adds in another order, and both agree to rounding.
#include "image/blur.hpp"

#include "image/lanes.hpp"
#include "pictures.hpp"

namespace flowdlo::image {
namespace {

testing::AssertionResult agree(const Image<float>& own, const cv::Mat& opencv) {
  if (has_wide_lanes()) return same_bits(mat::mat_over(own), opencv);
  const double apart = cv::norm(mat::mat_over(own), opencv, cv::NORM_INF);
  if (apart <= 1e-6) return testing::AssertionSuccess();
  return testing::AssertionFailure() << apart;
}

TEST(Gaussian, HasTheTapsOfOpenCv) {
  for (double sigma = 0.8; sigma < 4.05; sigma += 0.01) {
    const int taps = taps_of(sigma);
    const cv::Mat expected = cv::getGaussianKernel(taps, sigma, CV_32F);
    const std::vector<float> own = gaussian(taps, sigma);
    for (int i = 0; i < taps; ++i) {
      ASSERT_EQ(own[static_cast<std::size_t>(i)], expected.at<float>(i)) << sigma;
    }
  }
}

TEST(Blur, OfAnyWidthIsThatOfOpenCv) {
  cv::RNG random(3);
  for (std::uint64_t number = 0; number < 300; ++number) {
    const cv::Size size(random.uniform(1, 200), random.uniform(1, 150));
    const double sigma = 0.8 + 0.01 * random.uniform(0, 320);
    const cv::Mat values = some_values(size, CV_32F, number);
    const auto taps = gaussian(taps_of(sigma), sigma);
    cv::Mat expected;
    cv::GaussianBlur(values, expected, {}, sigma);
    ASSERT_TRUE(agree(blurred(mat::image_of<float>(values), taps, Beyond::kMirrored), expected))
        << size << " sigma " << sigma;
    const int side = taps_of(sigma);
    cv::GaussianBlur(values, expected, {side, side}, sigma, sigma, cv::BORDER_CONSTANT);
    ASSERT_TRUE(agree(blurred(mat::image_of<float>(values), taps, Beyond::kZero), expected))
        << size << " sigma " << sigma;
  }
}

TEST(Blur, OfSevenFixedTapsIsThatOfOpenCv) {
  const std::vector<float> taps{0.03125F, 0.109375F, 0.21875F, 0.28125F,
                                0.21875F, 0.109375F, 0.03125F};
  const cv::Mat values = some_values({83, 47}, CV_32F, 1);
  cv::Mat expected;
  cv::GaussianBlur(values, expected, {7, 7}, 0, 0, cv::BORDER_CONSTANT);
  EXPECT_TRUE(agree(blurred(mat::image_of<float>(values), taps, Beyond::kZero), expected));
}

}  // namespace
}  // namespace flowdlo::image
