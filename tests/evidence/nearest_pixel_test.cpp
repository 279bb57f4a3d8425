#include "evidence/nearest_pixel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "random/philox.hpp"

namespace flowdlo::evidence {
namespace {

using Pixels = std::vector<std::uint8_t>;

/// [height, width] index v * width + u of what is nearest to each pixel; empty when nothing is set.
std::vector<std::int32_t> nearest_set_pixel(const Pixels& set, int width, int height) {
  NearestPixels rows(set, width, height);
  std::vector<std::int32_t> nearest;
  for (int v = 0; v < height; ++v) {
    for (const Pixel& pixel : rows.of_row(v)) nearest.push_back(pixel.v * width + pixel.u);
  }
  return nearest;
}

std::vector<std::int32_t> search_everywhere(const Pixels& set, int width, int height) {
  std::vector<std::int32_t> nearest;
  for (int pixel = 0; pixel < width * height; ++pixel) {
    std::int32_t best = -1;
    int best_squared = 0;
    for (int other = 0; other < width * height; ++other) {
      if (set[static_cast<std::size_t>(other)] == 0) continue;
      const int du = other % width - pixel % width;
      const int dv = other / width - pixel / width;
      if (best >= 0 && du * du + dv * dv >= best_squared) continue;
      best = other;
      best_squared = du * du + dv * dv;
    }
    nearest.push_back(best);
  }
  return nearest;
}

Pixels scattered(int width, int height, double share, std::uint64_t seed) {
  Pixels set;
  for (int i = 0; i < width * height; ++i) {
    const auto words = random::philox(seed, static_cast<std::uint64_t>(i));
    set.push_back(random::uniform(words[0]) < share ? 1 : 0);
  }
  return set;
}

TEST(NearestPixel, IsEmptyWhereNothingIsSet) {
  EXPECT_TRUE(nearest_set_pixel(Pixels(12, 0), 4, 3).empty());
}

TEST(NearestPixel, OfASetPixelIsItself) {
  const Pixels set(35, 255);
  const auto nearest = nearest_set_pixel(set, 7, 5);
  for (std::size_t i = 0; i < set.size(); ++i) EXPECT_EQ(nearest[i], static_cast<int>(i));
}

TEST(NearestPixel, WorksOnOnePixel) {
  EXPECT_EQ(nearest_set_pixel(Pixels{1}, 1, 1), (std::vector<std::int32_t>{0}));
  EXPECT_TRUE(nearest_set_pixel(Pixels{0}, 1, 1).empty());
}

// Around (5, 5) all of these lie 5 px away: (5, 0), (1, 2), (9, 2), (0, 5), (10, 5), (5, 10).
TEST(NearestPixel, OfManyOnOneCircleIsTheUpperThenTheLeftOne) {
  Pixels set(121, 0);
  const auto index = [](int u, int v) { return v * 11 + u; };
  const std::vector<int> circle{index(5, 0), index(1, 2),  index(9, 2),
                                index(0, 5), index(10, 5), index(5, 10)};
  for (const int pixel : circle) set[static_cast<std::size_t>(pixel)] = 1;
  for (const int winner : circle) {
    EXPECT_EQ(nearest_set_pixel(set, 11, 11)[static_cast<std::size_t>(index(5, 5))], winner);
    set[static_cast<std::size_t>(winner)] = 0;
  }
}

TEST(NearestPixel, IsExactWhereEverythingWasSearched) {
  struct Size {
    int width;
    int height;
  };
  std::uint64_t seed = 0;
  for (const Size size : {Size{1, 40}, Size{40, 1}, Size{17, 23}, Size{32, 24}}) {
    for (const double share : {0.003, 0.03, 0.3, 0.8}) {
      const Pixels set = scattered(size.width, size.height, share, ++seed);
      const auto found = nearest_set_pixel(set, size.width, size.height);
      if (found.empty()) continue;
      EXPECT_EQ(found, search_everywhere(set, size.width, size.height))
          << size.width << " x " << size.height << ", " << share;
    }
  }
}

TEST(NearestPixel, IsExactOnALatticeFullOfTies) {
  Pixels set(31 * 31, 0);
  for (std::size_t v = 0; v < 31; v += 6) {
    for (std::size_t u = 0; u < 31; u += 6) set[v * 31 + u] = 1;
  }
  EXPECT_EQ(nearest_set_pixel(set, 31, 31), search_everywhere(set, 31, 31));
}

// Rows whose own set pixels stand at either border, at both, or alone.
TEST(NearestPixel, IsExactInEveryStretchOfARow) {
  for (int row = 0; row < 1 << 6; ++row) {
    Pixels set(6 * 3, 0);
    for (int u = 0; u < 6; ++u) set[static_cast<std::size_t>(6 + u)] = row >> u & 1;
    set[4] = set[12] = 1;  // above and below
    EXPECT_EQ(nearest_set_pixel(set, 6, 3), search_everywhere(set, 6, 3)) << row;
  }
}

TEST(NearestPixel, SpansTheLargestField) {
  Pixels set(std::size_t{2048} * 2048, 0);
  set.back() = 1;
  const auto nearest = nearest_set_pixel(set, 2048, 2048);
  EXPECT_EQ(nearest.front(), 2048 * 2048 - 1);
  EXPECT_EQ(nearest.back(), 2048 * 2048 - 1);
}

}  // namespace
}  // namespace flowdlo::evidence
