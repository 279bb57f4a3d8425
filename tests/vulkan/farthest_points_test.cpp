#include <cmath>
#include <cstring>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

using Cloud = std::vector<float>;  // [count, 4]

std::vector<float> params_of(const Cloud& cloud) {
  ops::FrameParams params{};
  params.point_count = static_cast<float>(cloud.size() / 4);
  double sum[3] = {0, 0, 0};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % 4 < 3) sum[i % 4] += static_cast<double>(cloud[i]);
  }
  const double count = std::max(1.0, static_cast<double>(cloud.size() / 4));
  params.centroid_x = static_cast<float>(sum[0] / count);
  params.centroid_y = static_cast<float>(sum[1] / count);
  params.centroid_z = static_cast<float>(sum[2] / count);
  std::vector<float> values(16);
  std::memcpy(values.data(), &params, sizeof(params));
  return values;
}

Record farthest(const Cloud& cloud, int capacity) {
  return [=](Trial& trial) {
    const auto points = trial.input(capacity, 4, cloud);
    const auto params = trial.input(1, 16, params_of(cloud));
    const auto visible = trial.output(256, 4);
    trial->record(ops::FarthestPoints{.cloud = points, .params = params, .visible = visible});
  };
}

Cloud scattered(int count, std::uint64_t seed) {
  return noise(static_cast<std::size_t>(count) * 4, seed, 0.1F);
}

/// Points of a coarse lattice, each several times over: ties at every pick.
Cloud lattice(int count) {
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    const int cell = (i * 7919) % 1331;
    const auto at = [](int index) { return 0.125F * static_cast<float>(index); };
    cloud.insert(cloud.end(), {at(cell % 11), at(cell / 11 % 11), at(cell / 121), 0.0F});
  }
  return cloud;
}

/// A tilted plane seen by every pixel of a 640 x 480 camera, row by row.
Cloud full_mask() {
  Cloud cloud;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const float z = 0.4F + 0.0001F * static_cast<float>(u - v);
      cloud.insert(cloud.end(), {z * static_cast<float>(u - 320) / 600.0F,
                                 z * static_cast<float>(v - 240) / 600.0F, z, 0.0F});
    }
  }
  return cloud;
}

class FarthestPointsOf : public ::testing::TestWithParam<int> {};

TEST_P(FarthestPointsOf, ScatteredPointsEqualTheTwinsBitForBit) {
  FLOWDLO_NEEDS_DEVICE();
  expect_equal_bits(farthest(scattered(GetParam(), 11), 6000));
}

TEST_P(FarthestPointsOf, ALatticeFullOfTiesEqualTheTwinsBitForBit) {
  FLOWDLO_NEEDS_DEVICE();
  expect_equal_bits(farthest(lattice(GetParam()), 6000));
}
INSTANTIATE_TEST_SUITE_P(Counts, FarthestPointsOf,
                         ::testing::Values(0, 1, 255, 256, 257, 2048, 2049, 5000));

TEST(FarthestPoints, OfAFullMaskEqualTheTwinsBitForBit) {
  FLOWDLO_NEEDS_DEVICE();
  expect_equal_bits(farthest(full_mask(), 640 * 480));
}

TEST(FarthestPoints, FollowTheNumberOfPointsFromFrameToFrame) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const Cloud many = scattered(5000, 1);
    const Cloud few = scattered(40, 2);
    Trial trial(create_program(device, {.timeout_ms = 60000, .pipeline_cache = {}}));
    farthest(many, 5000)(trial);
    const Outputs first = trial.run();
    EXPECT_EQ(trial.run_again({few, params_of(few)}), run_on_cpu(farthest(few, 5000)));
    EXPECT_EQ(trial.run_again({many, params_of(many)}), first);
    EXPECT_EQ(first, run_on_cpu(farthest(many, 5000)));
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
