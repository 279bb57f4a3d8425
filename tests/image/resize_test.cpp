// Images at other sizes have the bits of OpenCV's.
#include "image/resize.hpp"

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

using Three = std::array<float, 3>;

/// Sizes from and to: any, whole multiples up and down, one side kept.
struct Sizes {
  cv::Size from;
  cv::Size to;
};
Sizes some_sizes(int number) {
  cv::RNG random(static_cast<std::uint64_t>(number + 1));
  const cv::Size any(random.uniform(1, 200), random.uniform(1, 150));
  const cv::Size other(random.uniform(1, 300), random.uniform(1, 300));
  const int times = random.uniform(2, 7);
  switch (number % 4) {
    case 0:
      return {any, any * times};
    case 1:
      return {any * times, any};
    case 2:
      return {any, {any.width, other.height}};
    default:
      return {any, other};
  }
}

template <class T, class Resize>
testing::AssertionResult as_opencv(const Sizes& sizes, int method, const Resize& resize) {
  const cv::Mat values = some_values(sizes.from, mat::Kind<T>::kType, 9);
  cv::Mat expected;
  cv::resize(values, expected, sizes.to, 0, 0, method);
  const Image<T> own = resize(mat::image_of<T>(values), mat::size_of(sizes.to));
  const auto result = same_bits(mat::mat_over(own), expected);
  return result ? result : testing::AssertionFailure() << sizes.from << " to " << result.message();
}

TEST(Resize, OfTheNearestPixels) {
  for (int number = 0; number < 200; ++number) {
    const Sizes sizes = some_sizes(number);
    ASSERT_TRUE(as_opencv<std::uint8_t>(sizes, cv::INTER_NEAREST, nearest<std::uint8_t>));
    ASSERT_TRUE(as_opencv<std::uint16_t>(sizes, cv::INTER_NEAREST, nearest<std::uint16_t>));
    ASSERT_TRUE(as_opencv<float>(sizes, cv::INTER_NEAREST, nearest<float>));
  }
}

TEST(Resize, Bilinear) {
  for (int number = 0; number < 200; ++number) {
    Sizes sizes = some_sizes(number);
    if (2 * sizes.to.width == sizes.from.width) ++sizes.to.width;  // OpenCV takes means for a half
    ASSERT_TRUE(as_opencv<float>(sizes, cv::INTER_LINEAR, bilinear<float>));
    ASSERT_TRUE(as_opencv<Three>(sizes, cv::INTER_LINEAR, bilinear<Three>));
  }
}

TEST(Resize, ByMeans) {
  for (int number = 0; number < 400; ++number) {
    const Sizes sizes = some_sizes(number);
    ASSERT_TRUE(as_opencv<float>(sizes, cv::INTER_AREA, area_mean<float>));
    ASSERT_TRUE(as_opencv<Three>(sizes, cv::INTER_AREA, area_mean<Three>));
    const bool shrinks = sizes.to.width <= sizes.from.width && sizes.to.height <= sizes.from.height;
    if (!shrinks) continue;  // masks never grow that way
    ASSERT_TRUE(as_opencv<std::uint8_t>(sizes, cv::INTER_AREA, area_mean<std::uint8_t>));
  }
}

}  // namespace
}  // namespace flowdlo::image
