#include <gtest/gtest.h>

#include <cmath>

#include "reference/program.hpp"
#include "support/program_cases.hpp"

namespace flowdlo {
namespace {

using testing::noise;

std::vector<float> layer_norm(const std::vector<float>& input, const std::vector<float>& gain,
                              const std::vector<float>& shift) {
  auto program = reference::create_program(2);
  const int rows = static_cast<int>(input.size() / 256);
  const auto x = program->input("x", rows, 256);
  const auto y = program->output("y", rows, 256);
  program->record(ops::LayerNorm{.x = x,
                                 .gain = program->constant("gain", 1, 256, gain),
                                 .shift = program->constant("shift", 1, 256, shift),
                                 .y = y});
  EXPECT_TRUE(program->build());
  program->write(x, input);
  EXPECT_TRUE(program->run());
  std::vector<float> result(input.size());
  program->read(y, result);
  return result;
}

TEST(LayerNorm, KeepsItsDigitsWhenTheMeanDwarfsTheSpread) {
  auto input = noise(64 * 256, 1, 0.01F);
  for (float& value : input) value += 100.0F;
  const auto y = layer_norm(input, std::vector<float>(256, 1.0F), std::vector<float>(256, 0.0F));
  double mean = 0;
  for (std::size_t i = 0; i < 256; ++i) mean += static_cast<double>(input[i]) / 256;
  double variance = 0;
  for (std::size_t i = 0; i < 256; ++i)
    variance += std::pow(static_cast<double>(input[i]) - mean, 2) / 256;
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(y[i], (static_cast<double>(input[i]) - mean) / std::sqrt(variance + 1e-5), 2e-3);
  }
}

TEST(LayerNorm, ConstantRowBecomesTheShift) {
  const auto shift = noise(256, 2);
  const auto y = layer_norm(std::vector<float>(64 * 256, 3.5F), noise(256, 1), shift);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_FLOAT_EQ(y[i], shift[i]);
}

}  // namespace
}  // namespace flowdlo
