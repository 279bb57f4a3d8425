#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "support/block_maps.hpp"
#include "vulkan/device.hpp"
#include "vulkan/gemm_candidates.hpp"
#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

using flowdlo::testing::block_map;
using flowdlo::testing::BlockMap;
using flowdlo::testing::plain_convolution;
using ::testing::HasSubstr;

constexpr float kTolerance = 1e-5F;  // f32 sums in another order
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Shape {
  int side;
  int in;
  int out;
  int taps;
  bool relu;
};

std::size_t count(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

/// Rows of blocks that are not in use hold what no result may depend on.
std::vector<float> image(const BlockMap& map, const Shape& shape) {
  const int places = shape.side * shape.side;
  auto values = noise(count(map.used() * places, shape.in), 1);
  values.resize(count(map.capacity * places, shape.in), kNaN);
  return values;
}

std::vector<float> weight_of(const Shape& shape) {
  const float scale = 1.0F / std::sqrt(static_cast<float>(shape.taps * shape.in));
  return noise(count(shape.out, shape.taps * shape.in), 2, scale);
}

std::vector<float> bias_of(const Shape& shape) { return noise(count(1, shape.out), 3); }

Record convolution(const BlockMap& map, const Shape& shape) {
  return [=](Trial& trial) {
    const int rows = map.capacity * shape.side * shape.side;
    const auto x = trial.input(rows, shape.in, image(map, shape));
    const auto around = trial.input(map.capacity, 12, map.rows);
    const auto y = trial.output(rows, shape.out);
    const auto layer = trial->convolution("layer", shape.out, shape.taps, shape.in,
                                          weight_of(shape), bias_of(shape));
    trial->record(ops::Convolution{
        .x = x, .map = around, .layer = layer, .y = y, .side = shape.side, .relu = shape.relu});
  };
}

/// Of the result, what belongs to blocks in use.
std::vector<float> in_use(std::vector<float> y, const BlockMap& map, const Shape& shape) {
  y.resize(count(map.used() * shape.side * shape.side, shape.out));
  return y;
}

void expect_twin(const BlockMap& map, const Shape& shape) {
  SCOPED_TRACE(::testing::Message()
               << "side " << shape.side << ", " << shape.in << " to " << shape.out << ", "
               << shape.taps << " taps, " << map.used() << " of " << map.capacity << " blocks");
  const auto expected = in_use(run_on_cpu(convolution(map, shape))[0], map, shape);
  for (const auto& device : devices()) {
    SCOPED_TRACE(report(*device).name);
    const Outputs got = run_on(device, convolution(map, shape));
    ASSERT_EQ(got.size(), 1U);
    expect_near(expected, in_use(got[0], map, shape), kTolerance);
  }
}

TEST(Convolution, EqualsItsTwinForEverySideAndNumberOfTaps) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(9, 6, 3, 5);
  for (const bool relu : {false, true}) {
    for (const int side : {16, 8, 4}) {
      expect_twin(map, {side, 32, 48, 9, relu});
      expect_twin(map, {side, 48, 32, 1, relu});
    }
  }
}

TEST(Convolution, EqualsItsTwinForEveryNumberOfChannels) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(7, 5, 3, 6);
  for (const int in : {16, 32, 48, 96}) {
    for (const int out : {16, 32, 48, 96}) {
      expect_twin(map, {8, in, out, 9, true});
      expect_twin(map, {4, in, out, 1, false});
    }
  }
}

TEST(Convolution, EqualsThePlainSumOverThePicture) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(6, 6, 3, 8);
  const Shape shape{8, 32, 32, 9, false};
  const auto plain = plain_convolution(map, shape.side, shape.in, shape.out, shape.taps, shape.relu,
                                       image(map, shape), weight_of(shape), bias_of(shape));
  const std::vector<float> expected(plain.begin(), plain.end());
  for (const auto& device : devices()) {
    SCOPED_TRACE(report(*device).name);
    expect_near(expected, run_on(device, convolution(map, shape))[0], kTolerance);
  }
}

TEST(Convolution, EqualsItsTwinOnAnyMap) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int capacity : {1, 3, 13, 27}) {
    for (const int used : {1, capacity / 2 + 1, capacity}) {
      const BlockMap map = block_map(capacity, used, 6, static_cast<std::uint64_t>(used));
      expect_twin(map, {4, 16, 16, 9, true});
      expect_twin(map, {16, 16, 16, 9, false});
    }
  }
}

TEST(Convolution, OfMoreThanATexelBufferMayHoldEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  // 65536 texels are what Vulkan promises, and what SwiftShader has.
  expect_twin(block_map(23, 22, 5, 3), {16, 48, 16, 9, true});       // 70656 texels of x
  expect_twin(block_map(2, 2, 2, 3), {8, 96, 304, 9, true});         // 65664 of weights
  expect_twin(block_map(5500, 5490, 75, 3), {4, 16, 16, 1, false});  // 66000 of the map, one by one
}

TEST(Convolution, EqualsItsTwinWhicheverWayItReadsWeights) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(9, 7, 3, 5);
  for (const Shape& shape : {Shape{16, 32, 32, 9, true}, Shape{8, 48, 32, 1, false}}) {
    const auto expected = in_use(run_on_cpu(convolution(map, shape))[0], map, shape);
    for (const auto& device : devices()) {
      for (const GemmChoice& choice : gemm_candidates(device->facts())) {
        SCOPED_TRACE(report(*device).name + ", " + name_of(choice));
        Trial trial(
            create_program(device, {.timeout_ms = 60000, .pipeline_cache = {}, .gemm = choice}));
        convolution(map, shape)(trial);
        const Outputs got = trial.run();
        ASSERT_EQ(got.size(), 1U);
        expect_near(expected, in_use(got[0], map, shape), kTolerance);
      }
    }
  }
}

TEST(Convolution, GivesTheSameBitsWhateverBlocksLieBeyondItsNeighbours) {
  FLOWDLO_NEEDS_DEVICE();
  // The same lone block, first among one and first among many that do not touch it.
  const Shape shape{8, 32, 32, 9, true};
  const BlockMap one = block_map(1, 1, 1, 1);
  BlockMap many = block_map(40, 30, 7, 2);
  for (int entry = 0; entry < 9; ++entry) many.rows[entry] = entry == 4 ? 0.0F : -1.0F;
  for (const auto& device : devices()) {
    const auto alone = in_use(run_on(device, convolution(one, shape))[0], one, shape);
    auto among = run_on(device, convolution(many, shape))[0];
    among.resize(alone.size());
    EXPECT_EQ(alone, among) << report(*device).name;
  }
}

std::string failure_of(const Record& record) {
  Trial trial(create_program(devices().front(), {.timeout_ms = 60000, .pipeline_cache = {}}));
  record(trial);
  const auto built = trial->build();
  return built ? "" : built.error().message;
}

TEST(Convolution, RefusesWhatNoKernelTakes) {
  FLOWDLO_NEEDS_DEVICE();
  const BlockMap map = block_map(4, 4, 2, 1);
  EXPECT_THAT(failure_of(convolution(map, {4, 20, 16, 9, true})), HasSubstr("[16, 9, 20]"));
  EXPECT_THAT(failure_of(convolution(map, {4, 16, 24, 9, true})), HasSubstr("[24, 9, 16]"));
  EXPECT_THAT(failure_of(convolution(map, {4, 16, 16, 4, true})), HasSubstr("[16, 4, 16]"));
  EXPECT_THAT(failure_of(convolution(map, {5, 16, 16, 9, true})), HasSubstr("sides 16, 8 or 4"));
  EXPECT_THAT(failure_of(convolution(map, {16, 96, 16, 9, true})), HasSubstr("at most 16384"));
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
