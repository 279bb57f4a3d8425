#include <gtest/gtest.h>

#include <cmath>

#include "reference/program.hpp"
#include "support/program_cases.hpp"

namespace flowdlo {
namespace {

using testing::noise;

struct Case {
  int rows;
  int memory_rows;
  bool per_draw;
  std::vector<float> valid;  // [memory_rows, 4], or empty
};

std::vector<float> attend(const Case& c, const std::vector<float>& query,
                          const std::vector<float>& memory) {
  auto program = reference::create_program(2);
  const auto q = program->input("q", c.rows, 256);
  const auto kv = program->input("kv", c.memory_rows, 512);
  const auto valid = program->input("valid", c.memory_rows, 4);
  const auto out = program->output("out", c.rows, 256);
  ops::Attention op{.query = q,
                    .query_column = 0,
                    .key_value = kv,
                    .key_column = 0,
                    .value_column = 256,
                    .per_draw = c.per_draw,
                    .key_valid = std::nullopt,
                    .out = out};
  if (!c.valid.empty()) op.key_valid = valid;
  program->record(op);
  EXPECT_TRUE(program->build());
  program->write(q, query);
  program->write(kv, memory);
  if (!c.valid.empty()) program->write(valid, c.valid);
  EXPECT_TRUE(program->run());
  std::vector<float> result(static_cast<std::size_t>(c.rows) * 256);
  program->read(out, result);
  return result;
}

double expected(const Case& c, const std::vector<float>& query, const std::vector<float>& memory,
                std::size_t row, std::size_t channel) {
  const std::size_t head = channel / 32 * 32;
  const std::size_t first = c.per_draw ? row / 64 * 64 : 0;
  const std::size_t keys = c.per_draw ? 64 : static_cast<std::size_t>(c.memory_rows);
  double total = 0;
  double value = 0;
  for (std::size_t key = first; key < first + keys; ++key) {
    if (!c.valid.empty() && c.valid[key * 4 + 3] < 0.5F) continue;
    double dot = 0;
    for (std::size_t i = 0; i < 32; ++i) {
      dot += static_cast<double>(query[row * 256 + head + i]) *
             static_cast<double>(memory[key * 512 + head + i]);
    }
    const double weight = std::exp(dot / std::sqrt(32.0));
    total += weight;
    value += weight * static_cast<double>(memory[key * 512 + 256 + channel]);
  }
  return value / total;
}

void expect_equal_to_plain_sums(const Case& c) {
  const auto query = noise(static_cast<std::size_t>(c.rows) * 256, 1);
  const auto memory = noise(static_cast<std::size_t>(c.memory_rows) * 512, 2);
  const auto result = attend(c, query, memory);
  for (const std::size_t row : {0, 5, 63, c.rows - 1}) {
    for (const std::size_t channel : {0, 31, 32, 255}) {
      EXPECT_NEAR(result[row * 256 + channel], expected(c, query, memory, row, channel), 1e-5);
    }
  }
}

TEST(Attention, EachDrawSeesItsOwnRowsAlone) { expect_equal_to_plain_sums({192, 192, true, {}}); }

TEST(Attention, EveryDrawSeesAllPoints) { expect_equal_to_plain_sums({128, 256, false, {}}); }

TEST(Attention, InvalidKeysAreLeftOut) {  // spec section 6, key padding
  std::vector<float> valid(256 * 4, 0.0F);
  for (std::size_t key = 0; key < 256; key += 3) valid[key * 4 + 3] = 1.0F;
  expect_equal_to_plain_sums({64, 256, false, valid});
}

TEST(Attention, NoValidKeyContributesZero) {  // spec section 6
  const auto result = attend({64, 256, false, std::vector<float>(256 * 4, 0.0F)},
                             noise(64 * 256, 1), noise(256 * 512, 2));
  EXPECT_EQ(result, std::vector<float>(64 * 256, 0.0F));
}

TEST(Attention, HugeScoresDoNotOverflow) {
  const auto result =
      attend({64, 64, true, {}}, noise(64 * 256, 1, 300.0F), noise(64 * 512, 2, 300.0F));
  for (const float value : result) ASSERT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace flowdlo
