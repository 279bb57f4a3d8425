#include "weights/refine_weights.hpp"

#include <fmt/format.h>

#include "weights/seeded_noise.hpp"

namespace flowdlo::weights {
namespace {

constexpr std::string_view kPrefix = "refine.";

}  // namespace

std::vector<Expected> refine_manifest() {
  std::vector<Expected> expected;
  const auto add = [&](const std::string& name, int out, int taps, int in) {
    expected.push_back({fmt::format("{}{}.weight", kPrefix, name), {out, taps, in}});
    expected.push_back({fmt::format("{}{}.bias", kPrefix, name), {out}});
  };
  add("stem", kRefineStem, 1, kRefineInputs);
  for (int i = 0; i < kRefineSquares; ++i) {
    add(fmt::format("square.{}", i), kRefineWidth, 9, i == 0 ? kRefineStem : kRefineWidth);
  }
  add("head", kRefineOutputs, 1, kRefineWidth);
  return expected;
}

RefineWeights seeded_refine(std::uint64_t seed) {
  return {"", seeded_noise(refine_manifest(), seed)};
}

}  // namespace flowdlo::weights
