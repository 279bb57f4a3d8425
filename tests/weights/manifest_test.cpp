#include <gtest/gtest.h>

#include <map>
#include <set>

#include "weights/weights.hpp"

namespace flowdlo::weights {
namespace {

std::int64_t parameters(const Variant& variant, const std::string& prefix = "") {
  std::int64_t total = 0;
  for (const auto& [name, shape] : manifest(variant)) {
    if (name.rfind(prefix, 0) != 0) continue;
    std::int64_t count = 1;
    for (const int extent : shape) count *= extent;
    total += count;
  }
  return total;
}

std::map<std::string, std::vector<int>> shapes(const Variant& variant) {
  std::map<std::string, std::vector<int>> result;
  for (const auto& [name, shape] : manifest(variant)) result[name] = shape;
  return result;
}

TEST(Manifest, ThesisConfigurationHas5815044Parameters) { EXPECT_EQ(parameters({}), 5815044); }

TEST(Manifest, GroupsHaveTheParametersOfTheSpecification) {
  const std::map<std::string, std::int64_t> expected{{"state.", 1024},
                                                     {"time.", 131584},
                                                     {"node", 16384},
                                                     {"prior.", 1024},
                                                     {"support.", 512},
                                                     {"points.", 66816},
                                                     {"cross.", 264192 + 526080},
                                                     {"local.", 67584},
                                                     {"gamma", 1},
                                                     {"encoder.", 4738560},
                                                     {"norm.", 512},
                                                     {"head.", 771}};
  for (const auto& [prefix, count] : expected) EXPECT_EQ(parameters({}, prefix), count) << prefix;
}

TEST(Manifest, DepthResidualAddsTwoColumnsToTheFirstLocalLayer) {
  EXPECT_EQ(parameters({.local_channels = 8}), 5815044 + 2 * 256);
  EXPECT_EQ(shapes({.local_channels = 8})["local.0.weight"], (std::vector{256, 8}));
}

TEST(Manifest, FourthHeadChannelAddsOneRow) {
  EXPECT_EQ(parameters({.head_channels = 4}), 5815044 + 257);
  EXPECT_EQ(shapes({.head_channels = 4})["head.weight"], (std::vector{4, 256}));
  EXPECT_EQ(shapes({.head_channels = 4})["head.bias"], (std::vector{4}));
}

TEST(Manifest, WithoutVisiblePointsTheirTensorsAreAbsent) {
  const Variant blind{.visible_points = false};
  EXPECT_EQ(parameters(blind), 5815044 - 66816 - 264192 - 526080);
  EXPECT_EQ(parameters(blind, "points."), 0);
  EXPECT_EQ(parameters(blind, "cross."), 0);
}

TEST(Manifest, ParameterizationNormalizationAndPriorChangeNoTensor) {
  const Variant other{.parameterization = ops::Parameterization::kPreconditioned,
                      .normalization = NormalizationKind::kFrame,
                      .prior_kind = PriorKind::kRefined};
  EXPECT_EQ(shapes(other), shapes({}));
}

TEST(Manifest, ShapesArePyTorchs) {
  auto found = shapes({});
  EXPECT_EQ(found["node"], (std::vector{64, 256}));
  EXPECT_TRUE(found.at("gamma").empty());
  EXPECT_EQ(found["support.weight"], (std::vector{256, 1}));
  EXPECT_EQ(found["cross.kv.weight"], (std::vector{512, 256}));
  EXPECT_EQ(found["encoder.5.qkv.weight"], (std::vector{768, 256}));
  EXPECT_EQ(found["encoder.5.up.weight"], (std::vector{1024, 256}));
  EXPECT_EQ(found["encoder.5.down.weight"], (std::vector{256, 1024}));
  EXPECT_EQ(found["encoder.5.norm2.bias"], (std::vector{256}));
}

TEST(Manifest, NamesAreUniqueAndInTheSpecificationsOrder) {
  const auto list = manifest({});
  std::set<std::string> names;
  for (const auto& expected : list) names.insert(expected.name);
  EXPECT_EQ(names.size(), list.size());
  EXPECT_EQ(list.front().name, "state.weight");
  EXPECT_EQ(list.back().name, "head.bias");
}

}  // namespace
}  // namespace flowdlo::weights
