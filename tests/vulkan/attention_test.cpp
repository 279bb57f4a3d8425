#include <algorithm>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 1e-5F;

Record self_attention(int draws, float scale) {
  return [=](Trial& trial) {
    const int rows = draws * ops::kRowsPerDraw;
    const auto qkv = trial.input(rows, 768, noise(static_cast<std::size_t>(rows) * 768, 3, scale));
    const auto out = trial.output(rows, 256);
    trial->record(ops::Attention{.query = qkv,
                                 .query_column = 0,
                                 .key_value = qkv,
                                 .key_column = 256,
                                 .value_column = 512,
                                 .per_draw = true,
                                 .key_valid = {},
                                 .out = out});
  };
}

/// Validity of the 256 keys: every `stride`-th one, none where it is 0.
std::vector<float> validity(std::size_t stride) {
  std::vector<float> rows(256 * 4, 0.0F);
  for (std::size_t key = 0; stride > 0 && key < 256; key += stride) rows[4 * key + 3] = 1;
  return rows;
}

Record cross_attention(int draws, std::vector<float> valid) {
  return [=](Trial& trial) {
    const int rows = draws * ops::kRowsPerDraw;
    const auto query = trial.input(rows, 256, noise(static_cast<std::size_t>(rows) * 256, 3));
    const auto key_value = trial.input(256, 512, noise(256 * 512, 4));
    const auto points = trial.input(256, 4, valid);
    const auto out = trial.output(rows, 256);
    trial->record(ops::Attention{.query = query,
                                 .query_column = 0,
                                 .key_value = key_value,
                                 .key_column = 0,
                                 .value_column = 256,
                                 .per_draw = false,
                                 .key_valid = points,
                                 .out = out});
  };
}

TEST(Attention, WithinADrawEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int draws : {1, 3, 4, 64}) expect_twins(self_attention(draws, 1), kTolerance);
}

TEST(Attention, SurvivesLargeScores) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(self_attention(1, 12), 1e-4F);  // scores of several hundred: exp alone overflows
}

TEST(Attention, OverSharedKeysEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(cross_attention(1, validity(1)), kTolerance);
  expect_twins(cross_attention(4, validity(3)), kTolerance);
  expect_twins(cross_attention(20, validity(255)), kTolerance);
}

TEST(Attention, WithoutAnyValidKeyIsZero) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const auto out = run_on(device, cross_attention(3, validity(0)));
    EXPECT_TRUE(std::all_of(out[0].begin(), out[0].end(), [](float v) { return v == 0; }));
  }
}

TEST(Attention, GivesADrawTheSameBitsWhateverTheNumberOfDraws) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const auto one = run_on(device, self_attention(1, 1));
    const auto three = run_on(device, self_attention(3, 1));
    ASSERT_EQ(one[0].size(), 64U * 256U);
    EXPECT_TRUE(std::equal(one[0].begin(), one[0].end(), three[0].begin()));
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
