#include "link_fit/fit.hpp"

#include <gtest/gtest.h>

#include <random>

namespace flowdlo::lab {
namespace {

/// Scenes of four strands, of which ends 1 and 2 are linked, or 1 and 4: whichever is told to turn
/// less and by one hidden feature more. path/energy.hpp, as it were, cannot tell.
std::vector<LinkSample> scenes(int count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] {
    return static_cast<float>(static_cast<double>(engine() >> 11) / 9007199254740992);
  };
  std::vector<LinkSample> samples;
  for (int i = 0; i < count; ++i) {
    LinkSample& sample = samples.emplace_back();
    sample.ends.resize(6);
    for (auto& end : sample.ends) {
      end.partner = kStops;
      end.by_energy = 1;
      end.features = path::stop_features({});
    }
    const bool near = uniform() < 0.5F;
    const int partner = near ? 2 : 4;
    sample.ends[1].partner = partner;
    sample.ends[static_cast<std::size_t>(partner)].partner = 1;
    for (const int b : {2, 4}) {
      path::PairFeatures pair{};
      pair[path::kPairTurn] = (b == partner ? 0.1F : 0.4F) + 0.2F * uniform();
      path::LinkSide from{};
      path::LinkSide to{};
      from.end[path::kEndLength] = to.end[path::kEndLength] = 2 * uniform();
      sample.links.push_back({.a = 1,
                              .b = b,
                              .by_energy = 1,
                              .forth = path::link_features(pair, from, to),
                              .back = path::link_features(pair, to, from)});
    }
  }
  return samples;
}

TEST(LinkFit, LearnsWhichOfTwoLinksIsRight) {
  const auto weights = fit_links(scenes(240, 1), 700);
  const auto others = scenes(80, 2);
  const LinkQuality before = quality_of(others, nullptr);
  const LinkQuality now = quality_of(others, &weights);
  EXPECT_EQ(now.choices, before.choices);
  EXPECT_GT(before.unlikely, 0.3);
  EXPECT_LT(now.wrong, 0.02);
  EXPECT_LT(now.unlikely, 0.3 * before.unlikely);
}

TEST(LinkFit, IsTheSameForTheSameScenes) {
  const auto samples = scenes(30, 1);
  const auto a = fit_links(samples, 3);
  const auto b = fit_links(samples, 3);
  ASSERT_EQ(a.tensors.size(), weights::links_manifest().size());
  for (std::size_t i = 0; i < a.tensors.size(); ++i) {
    EXPECT_EQ(a.tensors[i].name, weights::links_manifest()[i].name);
    EXPECT_EQ(a.tensors[i].values, b.tensors[i].values);
  }
}

}  // namespace
}  // namespace flowdlo::lab
