#include "reference/layer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "reference/program.hpp"
#include "support/program_cases.hpp"
#include "weights/half.hpp"

namespace flowdlo::reference {
namespace {

using testing::noise;

constexpr int kIn = 256;
constexpr int kOut = 128;

std::vector<float> rounded_to_halves(std::vector<float> values) {
  for (float& value : values) value = weights::half_to_float(weights::float_to_half(value));
  return values;
}

/// Those of this processor, told to widen halves or not to.
Kernels kernels(bool widens_halves) {
  Kernels kernels = kernels_of_this_cpu().front();
  kernels.widens_halves = widens_halves;
  return kernels;
}

Layer layer_of(const std::vector<float>& weight, bool widens_halves) {
  return linear_layer(kernels(widens_halves), kOut, kIn, weight, noise(kOut, 2));
}

TEST(LinearLayer, KeepsHalvesOfTheSameValuesForKernelsThatWidenThem) {
  const auto weight = rounded_to_halves(noise(kOut * kIn, 1, 0.1F));
  const Layer floats = layer_of(weight, false);
  const Layer halves = layer_of(weight, true);
  ASSERT_EQ(floats.weight.size(), weight.size());
  EXPECT_EQ(floats.halves.size(), 0U);
  EXPECT_EQ(halves.weight.size(), 0U);
  ASSERT_EQ(halves.halves.size(), weight.size());
  for (std::size_t i = 0; i < weight.size(); ++i) {
    ASSERT_EQ(weights::half_to_float(halves.halves.data()[i]), floats.weight.data()[i]) << i;
  }
}

TEST(LinearLayer, OneValueThatIsNoHalfKeepsAllOfItsLayerInFloats) {
  auto weight = rounded_to_halves(noise(kOut * kIn, 1, 0.1F));
  weight[777] = 0.1F;
  const Layer layer = layer_of(weight, true);
  EXPECT_EQ(layer.halves.size(), 0U);
  EXPECT_EQ(layer.weight.size(), weight.size());
}

std::vector<float> product(int in, bool widens_halves) {
  constexpr int kRows = 64;
  const auto count = static_cast<std::size_t>(kOut) * static_cast<std::size_t>(in);
  auto program = create_program(2, kernels(widens_halves));
  const auto x = program->input("x", kRows, in);
  const auto y = program->output("y", kRows, kOut);
  const auto layer =
      program->layer("w", kOut, in, rounded_to_halves(noise(count, 1, 0.1F)), noise(kOut, 2));
  program->record(ops::Linear{.x = x, .layer = layer, .y = y});
  EXPECT_TRUE(program->build());
  program->write(x, noise(static_cast<std::size_t>(kRows) * static_cast<std::size_t>(in), 3));
  EXPECT_TRUE(program->run());
  std::vector<float> result(static_cast<std::size_t>(kRows) * kOut);
  program->read(y, result);
  return result;
}

TEST(LinearLayer, BitsDoNotDependOnWhetherHalvesOrFloatsAreKept) {
  if (!kernels_of_this_cpu().front().widens_halves) {
    GTEST_SKIP() << "the kernels of this processor take floats alone";
  }
  for (const int in : {ops::kWidth, 4 * ops::kWidth})
    EXPECT_EQ(product(in, true), product(in, false));
}

}  // namespace
}  // namespace flowdlo::reference
