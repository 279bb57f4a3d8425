#include "weights/link_weights.hpp"

#include "weights/seeded_noise.hpp"

namespace flowdlo::weights {

std::vector<Expected> links_manifest() { return bent_manifest("links", kLinkInputs, kLinkHidden); }

LinkWeights seeded_links(std::uint64_t seed) { return {"", seeded_noise(links_manifest(), seed)}; }

}  // namespace flowdlo::weights
