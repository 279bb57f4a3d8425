#include "field/resampling.hpp"

#include <gtest/gtest.h>

#include <random>

#include "image/resize.hpp"

namespace flowdlo::field {
namespace {

using One = std::array<float, 1>;

image::Image<float> noise(const image::Size& size) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(0, 1);
  image::Image<float> image(size);
  for (std::size_t i = 0; i < image.total(); ++i) image.data()[i] = value(random);
  return image;
}

/// `part` of `given` at the size of `wanted`, against that of `wanted`.
void expect_part(const image::Image<float>& given, const image::Image<float>& wanted,
                 const image::Rect& part) {
  const Resampling resampling(given.size(), wanted.size());
  const image::Rect source = resampling.source_of(part);
  std::vector<One> from;
  for (int v = source.y; v < source.y + source.height; ++v) {
    for (int u = source.x; u < source.x + source.width; ++u) from.push_back({given.at(v, u)});
  }
  std::vector<One> to(static_cast<std::size_t>(part.area()));
  std::vector<One> rows;
  resampling.resample(from.data(), source, part, to.data(), part.width, rows);
  for (int i = 0; i < part.area(); ++i) {
    const image::Point at{part.x + i % part.width, part.y + i / part.width};
    ASSERT_NEAR(to[static_cast<std::size_t>(i)][0], wanted.at(at), 1e-6F)
        << wanted.width() << " x " << wanted.height() << " at " << at.x << ", " << at.y;
  }
}

TEST(Resampling, PartsOfALargerImageAreTheBilinearOnes) {
  const auto given = noise({37, 23});
  for (const image::Size size : {image::Size{37, 23}, {74, 46}, {100, 61}, {148, 20}}) {
    const auto wanted = image::bilinear<float>(given, size);
    expect_part(given, wanted, image::all_of(size));
    expect_part(given, wanted, {11, 7, 16, 9});
  }
}

TEST(Resampling, PartsOfASmallerImageAreTheMeans) {
  const auto given = noise({96, 60});
  for (const image::Size size : {image::Size{48, 30}, {32, 20}, {77, 51}, {40, 60}, {29, 64}}) {
    const auto wanted = image::area_mean<float>(given, size);
    expect_part(given, wanted, image::all_of(size));
    expect_part(given, wanted, {11, 7, 16, 9});
  }
}

}  // namespace
}  // namespace flowdlo::field
