#include "tip_fit/fit.hpp"

#include <gtest/gtest.h>

#include <random>

namespace flowdlo::lab {
namespace {

/// Ends whose tip lies half a width before them where the field shows a tip, else more than that
/// beyond; some are hidden, far beyond what may be said.
std::vector<TipSample> ends(int count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] {
    return static_cast<float>(static_cast<double>(engine() >> 11) / 9007199254740992);
  };
  std::vector<TipSample> samples;
  for (int i = 0; i < count; ++i) {
    TipSample& sample = samples.emplace_back();
    sample.index = static_cast<std::uint64_t>(i);
    sample.features[refine::kTipOne] = 1;
    for (std::size_t k = 1; k < refine::kTipColumns; ++k) sample.features[k] = uniform();
    const bool shows = uniform() < 0.5F;
    sample.features[refine::kTipAhead] = shows ? 1.0F : 0.0F;
    sample.beyond_widths = shows ? -0.5F : 0.6F + 0.1F * uniform();
    if (uniform() < 0.1F) sample.beyond_widths = 40;
  }
  return samples;
}

TEST(TipFit, LearnsWhereTheMedianTipLies) {
  const auto weights = fit_tips(ends(800, 1), 600);
  const auto others = ends(400, 2);
  const TipQuality before = quality_of(others, nullptr);
  const TipQuality now = quality_of(others, &weights);
  EXPECT_EQ(now.ends, 400U);
  EXPECT_GT(before.median, 0.4);
  EXPECT_LT(now.median, 0.12);
  EXPECT_LT(now.mean, 0.75 * before.mean);
}

TEST(TipFit, IsTheSameForTheSameEnds) {
  const auto samples = ends(60, 1);
  const auto a = fit_tips(samples, 3);
  const auto b = fit_tips(samples, 3);
  ASSERT_EQ(a.tensors.size(), weights::tips_manifest().size());
  for (std::size_t i = 0; i < a.tensors.size(); ++i) {
    EXPECT_EQ(a.tensors[i].name, weights::tips_manifest()[i].name);
    EXPECT_EQ(a.tensors[i].values, b.tensors[i].values);
  }
}

}  // namespace
}  // namespace flowdlo::lab
