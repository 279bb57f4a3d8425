// Farthest-point sampling, Sec. 3.2, against a plain loop over every point, bit for bit.
#include "reference/farthest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "random/philox.hpp"

namespace flowdlo::reference {
namespace {

constexpr std::size_t kRows = 256;
using Position = std::array<float, 3>;
using Visible = std::array<float, 4 * kRows>;

std::vector<float> to_rows(const std::vector<Position>& points) {
  std::vector<float> rows;
  for (const Position& p : points) rows.insert(rows.end(), {p[0], p[1], p[2], -7.0F});
  return rows;
}

Position mean_of(const std::vector<Position>& points) {
  std::array<double, 3> sum{};
  for (const Position& p : points) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(p[c]);
  }
  Position mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    mean[c] = static_cast<float>(sum[c] / static_cast<double>(points.size()));
  }
  return mean;
}

Visible sample(const std::vector<Position>& points, const Position& centroid) {
  Visible visible;
  visible.fill(std::numeric_limits<float>::quiet_NaN());
  farthest_points(to_rows(points), static_cast<int>(points.size()), centroid.data(), visible);
  return visible;
}

Visible sample_naively(const std::vector<Position>& points, const Position& centroid) {
  std::vector<float> nearest(points.size(), std::numeric_limits<float>::infinity());
  Visible visible{};
  Position from = centroid;
  for (std::size_t row = 0; row < kRows; ++row) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float dx = points[i][0] - from[0];
      const float dy = points[i][1] - from[1];
      const float dz = points[i][2] - from[2];
      const float distance = (dx * dx + dy * dy) + dz * dz;
      nearest[i] = std::min(nearest[i], distance);
      if (nearest[i] > nearest[best]) best = i;
    }
    if (row == 0) std::fill(nearest.begin(), nearest.end(), std::numeric_limits<float>::infinity());
    from = points[best];
    std::copy(from.begin(), from.end(), visible.begin() + static_cast<std::ptrdiff_t>(4 * row));
    visible[4 * row + 3] = 1;
  }
  return visible;
}

std::vector<Position> gaussian_cloud(int count, float scale, const Position& offset) {
  std::vector<Position> points;
  for (int i = 0; i < count; ++i) {
    const auto g = random::gaussian(5, static_cast<std::uint64_t>(i));
    points.push_back(
        {offset[0] + scale * g[0], offset[1] + scale * g[1], offset[2] + scale * g[2]});
  }
  return points;
}

std::vector<Position> lattice(int columns, int rows, int layers, float step) {
  std::vector<Position> points;
  for (int k = 0; k < layers; ++k) {
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < columns; ++u) {
        points.push_back({static_cast<float>(u) * step, static_cast<float>(v) * step,
                          static_cast<float>(k) * step});
      }
    }
  }
  return points;
}

void expect_as_the_plain_loop(const std::vector<Position>& points) {
  const Position centroid = mean_of(points);
  EXPECT_EQ(sample(points, centroid), sample_naively(points, centroid));
}

// 512 points x = 0..511 and a centroid at 0: first 511, then 0; of 255 and 256, both 255 away from
// the nearer pick, the lower index.
TEST(FarthestPoints, StartAtTheFarthestFromTheCentroidAndBreakTiesToTheLowerIndex) {
  const Visible visible = sample(lattice(512, 1, 1, 1), {0, 0, 0});
  EXPECT_EQ(visible[0], 511);
  EXPECT_EQ(visible[4], 0);
  EXPECT_EQ(visible[8], 255);
}

TEST(FarthestPoints, TieOfTheFirstPickGoesToTheLowerIndex) {
  const Visible visible = sample(lattice(512, 1, 1, 1), {255.5F, 0, 0});
  EXPECT_EQ(visible[0], 0);
  EXPECT_EQ(visible[4], 511);
}

TEST(FarthestPoints, EqualThePlainLoopOnAScatteredCloud) {
  expect_as_the_plain_loop(gaussian_cloud(20011, 0.2F, {0, 0, 0.6F}));
}

TEST(FarthestPoints, EqualThePlainLoopWhereRoundingIsCoarse) {
  expect_as_the_plain_loop(gaussian_cloud(5003, 0.01F, {1000, -2000, 500}));
}

TEST(FarthestPoints, EqualThePlainLoopOnALatticeFullOfTies) {
  expect_as_the_plain_loop(lattice(16, 16, 16, 0.125F));
}

TEST(FarthestPoints, EqualThePlainLoopOnACloudOfAFullImage) {
  expect_as_the_plain_loop(lattice(640, 480, 1, 1.0F / 512));
}

TEST(FarthestPoints, EqualThePlainLoopJustAboveTheirNumber) {
  expect_as_the_plain_loop(gaussian_cloud(257, 1, {0, 0, 0}));
}

TEST(FarthestPoints, EqualThePlainLoopWhereDistancesOverflow) {
  std::vector<Position> points = gaussian_cloud(1000, 1, {0, 0, 0});
  for (std::size_t i = 0; i < points.size(); i += 7) points[i][0] *= 1e25F;
  expect_as_the_plain_loop(points);
}

TEST(FarthestPoints, PickEachDistinctPointOnceThenIndexZero) {
  std::vector<Position> points(300, Position{1, 0, 0});
  points[100] = {5, 0, 0};
  points[200] = {3, 0, 0};
  const Visible visible = sample(points, {1, 0, 0});
  EXPECT_EQ(visible[0], 5);
  EXPECT_EQ(visible[4], 1);
  EXPECT_EQ(visible[8], 3);
  for (std::size_t row = 3; row < kRows; ++row) {
    EXPECT_EQ(visible[4 * row], 1) << "row " << row;
    EXPECT_EQ(visible[4 * row + 3], 1) << "row " << row;
  }
}

TEST(FarthestPoints, KeepAllOfAFewInOrderAndRepeatThemAsInvalid) {
  const Visible visible = sample({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {0, 0, 0});
  for (std::size_t row = 0; row < kRows; ++row) {
    EXPECT_EQ(visible[4 * row], static_cast<float>(1 + 3 * (row % 3)));
    EXPECT_EQ(visible[4 * row + 3], row < 3 ? 1.0F : 0.0F);
  }
}

TEST(FarthestPoints, KeepExactlyTheirNumberInOrder) {
  const std::vector<Position> points = gaussian_cloud(256, 1, {0, 0, 0});
  const Visible visible = sample(points, {0, 0, 0});
  for (std::size_t row = 0; row < kRows; ++row) {
    EXPECT_EQ(visible[4 * row], points[row][0]);
    EXPECT_EQ(visible[4 * row + 3], 1);
  }
}

TEST(FarthestPoints, AreZeroWithoutAnyPoint) {
  const Visible visible = sample({}, {1, 1, 1});
  EXPECT_TRUE(std::all_of(visible.begin(), visible.end(), [](float value) { return value == 0; }));
}

TEST(FarthestPoints, DoNotReadColumnThree) {
  const std::vector<Position> points = gaussian_cloud(1000, 1, {0, 0, 0});
  std::vector<float> rows = to_rows(points);
  for (std::size_t i = 3; i < rows.size(); i += 4) rows[i] = std::nanf("");
  Visible visible{};
  const Position centroid = mean_of(points);
  farthest_points(rows, static_cast<int>(points.size()), centroid.data(), visible);
  EXPECT_EQ(visible, sample(points, centroid));
}

}  // namespace
}  // namespace flowdlo::reference
