#include "weights/tip_weights.hpp"

#include "weights/seeded_noise.hpp"

namespace flowdlo::weights {

std::vector<Expected> tips_manifest() { return bent_manifest("tips", kTipInputs, kTipHidden); }

TipWeights seeded_tips(std::uint64_t seed) { return {"", seeded_noise(tips_manifest(), seed)}; }

}  // namespace flowdlo::weights
