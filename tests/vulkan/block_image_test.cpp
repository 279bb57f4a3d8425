#include <gmock/gmock.h>

#include <limits>

#include "support/block_maps.hpp"
#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

using flowdlo::testing::block_map;
using flowdlo::testing::BlockMap;
using ::testing::HasSubstr;

std::size_t count(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

/// Rows of blocks that are not in use hold what no result may depend on.
std::vector<float> image(const BlockMap& map, int side, int channels, std::uint64_t seed) {
  auto values = noise(count(map.used() * side * side, channels), seed);
  values.resize(count(map.capacity * side * side, channels),
                std::numeric_limits<float>::quiet_NaN());
  return values;
}

Record max_pool(const BlockMap& map, int side, int channels) {
  return [=](Trial& trial) {
    const int rows = map.capacity * side * side;
    const auto x = trial.input(rows, channels, image(map, side, channels, 1));
    const auto around = trial.input(map.capacity, 12, map.rows);
    const auto y = trial.output(rows / 4, channels);
    trial->record(ops::MaxPool{.x = x, .map = around, .y = y, .side = side});
  };
}

Record add_upsampled(const BlockMap& map, int side, int channels) {
  return [=](Trial& trial) {
    const int rows = map.capacity * side * side;
    const auto x = trial.input(rows / 4, channels, image(map, side / 2, channels, 1));
    const auto before = trial.input(rows, channels, image(map, side, channels, 2));
    const auto around = trial.input(map.capacity, 12, map.rows);
    const auto y = trial.output(rows, channels);
    trial->record(ops::Copy{.from = before, .to = y});
    trial->record(ops::AddUpsampled{.x = x, .map = around, .y = y, .side = side});
  };
}

/// Bit for bit, in blocks in use.
void expect_equal(const BlockMap& map, int side_of_y, int channels, const Record& record) {
  const std::size_t size = count(map.used() * side_of_y * side_of_y, channels);
  auto expected = run_on_cpu(record)[0];
  expected.resize(size);
  for (const auto& device : devices()) {
    const Outputs got = run_on(device, record);
    ASSERT_EQ(got.size(), 1U);
    ASSERT_GE(got[0].size(), size);
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_EQ(expected[i], got[0][i]) << report(*device).name << ", side " << side_of_y << ", "
                                        << channels << " channels, entry " << i;
    }
  }
}

TEST(MaxPool, EqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int channels : {16, 32, 48, 96}) {
    for (const int capacity : {1, 7}) {
      const BlockMap map = block_map(capacity, capacity - capacity / 4, 3, 5);
      expect_equal(map, 8, channels, max_pool(map, 16, channels));
      expect_equal(map, 4, channels, max_pool(map, 8, channels));
    }
  }
}

TEST(AddUpsampled, EqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int channels : {16, 32, 48, 96}) {
    for (const int capacity : {1, 7}) {
      const BlockMap map = block_map(capacity, capacity - capacity / 4, 3, 5);
      expect_equal(map, 16, channels, add_upsampled(map, 16, channels));
      expect_equal(map, 8, channels, add_upsampled(map, 8, channels));
    }
  }
}

TEST(BlockImage, OfMoreThanATexelBufferMayHoldEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  // 65536 texels are what Vulkan promises, and what SwiftShader has: here are 70656 of the larger
  // image, then 66000 of the map, which is read one by one.
  const BlockMap large = block_map(23, 22, 5, 3);
  expect_equal(large, 8, 48, max_pool(large, 16, 48));
  expect_equal(large, 16, 48, add_upsampled(large, 16, 48));
  const BlockMap many = block_map(5500, 5490, 75, 3);
  expect_equal(many, 4, 16, max_pool(many, 8, 16));
  expect_equal(many, 8, 16, add_upsampled(many, 8, 16));
}

std::string failure_of(const Record& record) {
  Trial trial(create_program(devices().front(), {.timeout_ms = 60000, .pipeline_cache = {}}));
  record(trial);
  const auto built = trial->build();
  return built ? "" : built.error().message;
}

TEST(BlockImage, OfAnotherShapeIsRefused) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(4, 4, 2, 1);
  EXPECT_THAT(failure_of(max_pool(map, 4, 16)), HasSubstr("MaxPool: expected map [n, 12]"));
  EXPECT_THAT(failure_of(add_upsampled(map, 16, 24)), HasSubstr("AddUpsampled: expected map"));
  EXPECT_THAT(failure_of([](Trial& trial) {
                const auto x = trial.input(256, 16, noise(count(256, 16), 1));
                const auto around = trial.input(1, 12, block_map(1, 1, 1, 1).rows);
                const auto y = trial.output(64, 32);
                trial->record(ops::MaxPool{.x = x, .map = around, .y = y, .side = 16});
              }),
              HasSubstr("as many channels"));
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
