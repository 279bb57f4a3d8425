#include <gtest/gtest.h>

#include "reference/program.hpp"
#include "support/program_cases.hpp"

namespace flowdlo {
namespace {

using testing::noise;

TEST(Narrow, AddsBothTablesAtTheirOwnPeriodAndOffset) {
  auto program = reference::create_program(1);
  const auto x = program->input("x", 128, 4);
  const auto y = program->output("y", 128, 256);
  const auto per_node = program->constant("node", 64, 256, noise(64 * 256, 1));
  const auto per_step = program->constant("time", 3, 256, noise(3 * 256, 2));
  const auto layer = program->layer("state", 256, 3, noise(256 * 3, 3), noise(256, 4));
  program->record(ops::Narrow{.x = x,
                              .layer = layer,
                              .y = y,
                              .first = ops::Addend{per_node, 64, 0},
                              .second = ops::Addend{per_step, 1, 2}});
  ASSERT_TRUE(program->build());
  const auto input = noise(128 * 4, 5);
  program->write(x, input);
  ASSERT_TRUE(program->run());
  std::vector<float> result(128 * 256);
  program->read(y, result);

  const auto weight = noise(256 * 3, 3);
  const auto bias = noise(256, 4);
  const auto node = noise(64 * 256, 1);
  const auto time = noise(3 * 256, 2);
  for (const std::size_t row : {0U, 63U, 64U, 127U}) {
    for (const std::size_t column : {0U, 17U, 255U}) {
      float sum = bias[column] + node[row % 64 * 256 + column] + time[2 * 256 + column];
      for (std::size_t i = 0; i < 3; ++i) sum += weight[column * 3 + i] * input[row * 4 + i];
      EXPECT_NEAR(result[row * 256 + column], sum, 1e-5);
    }
  }
}

TEST(Narrow, ColumnsBeyondTheLayerDoNotContribute) {
  const auto run = [](float beyond) {
    auto program = reference::create_program(1);
    const auto x = program->input("x", 64, 8);
    const auto y = program->output("y", 64, 256);
    const auto layer = program->layer("local.0", 256, 6, noise(256 * 6, 3), noise(256, 4));
    program->record(
        ops::Narrow{.x = x, .layer = layer, .y = y, .activation = ops::Activation::kGelu});
    EXPECT_TRUE(program->build());
    auto input = noise(64 * 8, 5);
    for (std::size_t row = 0; row < 64; ++row) input[row * 8 + 6] = input[row * 8 + 7] = beyond;
    program->write(x, input);
    EXPECT_TRUE(program->run());
    std::vector<float> result(64 * 256);
    program->read(y, result);
    return result;
  };
  EXPECT_EQ(run(0.0F), run(1e6F));
}

}  // namespace
}  // namespace flowdlo
