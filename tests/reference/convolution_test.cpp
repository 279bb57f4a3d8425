#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "reference/kernels.hpp"
#include "reference/program.hpp"
#include "support/block_maps.hpp"
#include "support/program_cases.hpp"

namespace flowdlo {
namespace {

using testing::block_map;
using testing::BlockMap;
using testing::noise;
using testing::Picture;
using testing::plain_convolution;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kTolerance = 1e-5;  // of the largest expected: f32 sums of up to 864 products

struct Shape {
  int side;
  int in;
  int out;
  int taps;
  bool relu;
};

std::size_t count(int rows, int columns) { return static_cast<std::size_t>(rows) * columns; }

/// Rows of blocks that are not in use hold what no result may depend on.
std::vector<float> image(const BlockMap& map, int side, int channels, std::uint64_t seed) {
  auto values = noise(count(map.used() * side * side, channels), seed);
  values.resize(count(map.capacity * side * side, channels), kNaN);
  return values;
}

std::vector<float> weight_of(const Shape& shape) {
  const float scale = 1.0F / std::sqrt(static_cast<float>(shape.taps * shape.in));
  return noise(count(shape.out, shape.taps * shape.in), 2, scale);
}

std::vector<float> bias_of(const Shape& shape) { return noise(count(1, shape.out), 3); }

/// The rows of blocks in use.
std::vector<float> run(const Shape& shape, const BlockMap& map, const reference::Kernels& kernels,
                       int threads) {
  const auto program = reference::create_program(threads, kernels);
  const int places = map.capacity * shape.side * shape.side;
  const auto x = program->input("x", places, shape.in);
  const auto rows = program->input("map", map.capacity, 12);
  const auto y = program->output("y", places, shape.out);
  const auto layer = program->convolution("layer", shape.out, shape.taps, shape.in,
                                          weight_of(shape), bias_of(shape));
  program->record(ops::Convolution{
      .x = x, .map = rows, .layer = layer, .y = y, .side = shape.side, .relu = shape.relu});
  EXPECT_TRUE(program->build());
  program->write(x, image(map, shape.side, shape.in, 1));
  program->write(rows, map.rows);
  EXPECT_TRUE(program->run());
  std::vector<float> result(count(map.used() * shape.side * shape.side, shape.out));
  program->read(y, result);
  return result;
}

void expect_equal(const std::vector<double>& expected, const std::vector<float>& got) {
  ASSERT_EQ(expected.size(), got.size());
  double largest = 0;
  for (const double value : expected) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_NEAR(expected[i], static_cast<double>(got[i]), kTolerance * largest) << "entry " << i;
  }
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

class Convolution : public ::testing::TestWithParam<Shape> {};

TEST_P(Convolution, EqualsThePlainSumOverThePictureInDoublePrecision) {
  const Shape shape = GetParam();
  const BlockMap map = block_map(9, 6, 3, 5);
  const auto expected =
      plain_convolution(map, shape.side, shape.in, shape.out, shape.taps, shape.relu,
                        image(map, shape.side, shape.in, 1), weight_of(shape), bias_of(shape));
  for (const reference::Kernels& kernels : reference::kernels_of_this_cpu()) {
    SCOPED_TRACE(kernels.isa);
    const auto alone = run(shape, map, kernels, 1);
    expect_equal(expected, alone);
    for (const int threads : {2, 3}) {
      EXPECT_TRUE(same_bits(alone, run(shape, map, kernels, threads))) << threads << " threads";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Convolution,
                         ::testing::Values(Shape{16, 32, 32, 9, true}, Shape{16, 48, 96, 9, false},
                                           Shape{16, 16, 48, 9, true}, Shape{16, 48, 16, 1, true},
                                           Shape{8, 96, 48, 9, true}, Shape{8, 32, 96, 9, false},
                                           Shape{8, 96, 32, 1, false}, Shape{4, 96, 96, 9, true},
                                           Shape{4, 32, 48, 9, false}, Shape{4, 48, 112, 1, true}));

TEST(Convolution, OfALoneBlockSeesZerosAllAround) {
  const Shape shape{8, 16, 16, 9, false};
  const BlockMap map = block_map(1, 1, 1, 7);
  const auto expected =
      plain_convolution(map, shape.side, shape.in, shape.out, shape.taps, shape.relu,
                        image(map, shape.side, shape.in, 1), weight_of(shape), bias_of(shape));
  expect_equal(expected, run(shape, map, reference::kernels_of_this_cpu().front(), 1));
}

TEST(Convolution, OfAnImageWithoutBlocksWritesNothing) {
  const auto program = reference::create_program(2);
  const BlockMap map = block_map(3, 0, 2, 7);
  const auto x = program->input("x", 3 * 16, 16);
  const auto rows = program->input("map", 3, 12);
  const auto y = program->output("y", 3 * 16, 16);
  const auto layer = program->convolution("layer", 16, 9, 16, noise(16 * 9 * 16, 1), noise(16, 2));
  program->record(ops::Convolution{.x = x, .map = rows, .layer = layer, .y = y, .side = 4});
  ASSERT_TRUE(program->build());
  program->write(rows, map.rows);
  ASSERT_TRUE(program->run());
  std::vector<float> result(3 * 16 * 16);
  program->read(y, result);
  EXPECT_EQ(result, std::vector<float>(result.size(), 0.0F));
}

TEST(MaxPool, TakesTheLargestOfTwoByTwoPlaces) {
  const BlockMap map = block_map(5, 4, 3, 11);
  for (const int side : {16, 8}) {
    constexpr int kChannels = 48;
    const auto values = image(map, side, kChannels, 4);
    const auto program = reference::create_program(2);
    const auto x = program->input("x", map.capacity * side * side, kChannels);
    const auto rows = program->input("map", map.capacity, 12);
    const auto y = program->output("y", map.capacity * side * side / 4, kChannels);
    program->record(ops::MaxPool{.x = x, .map = rows, .y = y, .side = side});
    ASSERT_TRUE(program->build());
    program->write(x, values);
    program->write(rows, map.rows);
    ASSERT_TRUE(program->run());
    std::vector<float> result(count(map.used() * side * side / 4, kChannels));
    program->read(y, result);
    const Picture picture(map, side, kChannels, values);
    const Picture half(map, side / 2, kChannels);
    half.for_each_in_use([&](std::size_t row, int v, int u, int channel) {
      double largest = picture.seen(2 * v, 2 * u, channel);
      for (const auto& [dy, dx] : {std::pair{0, 1}, std::pair{1, 0}, std::pair{1, 1}}) {
        largest = std::max(largest, picture.seen(2 * v + dy, 2 * u + dx, channel));
      }
      ASSERT_EQ(largest, static_cast<double>(result[row * kChannels + channel])) << row;
    });
  }
}

TEST(AddUpsampled, AddsEachPlaceToTwoByTwo) {
  const BlockMap map = block_map(5, 4, 3, 13);
  for (const int side : {16, 8}) {
    constexpr int kChannels = 32;
    const auto coarse = image(map, side / 2, kChannels, 4);
    const auto fine = image(map, side, kChannels, 6);
    const auto program = reference::create_program(2);
    const auto x = program->input("x", map.capacity * side * side / 4, kChannels);
    const auto before = program->input("before", map.capacity * side * side, kChannels);
    const auto rows = program->input("map", map.capacity, 12);
    const auto y = program->output("y", map.capacity * side * side, kChannels);
    program->record(ops::Copy{.from = before, .to = y});
    program->record(ops::AddUpsampled{.x = x, .map = rows, .y = y, .side = side});
    ASSERT_TRUE(program->build());
    program->write(x, coarse);
    program->write(before, fine);
    program->write(rows, map.rows);
    ASSERT_TRUE(program->run());
    std::vector<float> result(count(map.used() * side * side, kChannels));
    program->read(y, result);
    const Picture added(map, side / 2, kChannels, coarse);
    const Picture shape(map, side, kChannels);
    shape.for_each_in_use([&](std::size_t row, int v, int u, int channel) {
      const std::size_t entry = row * kChannels + channel;
      const float sum = fine[entry] + static_cast<float>(added.seen(v / 2, u / 2, channel));
      ASSERT_EQ(sum, result[entry]) << row;
    });
  }
}

}  // namespace
}  // namespace flowdlo
