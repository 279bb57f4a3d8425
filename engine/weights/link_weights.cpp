#include "weights/link_weights.hpp"

#include <fmt/format.h>

#include "weights/seeded_noise.hpp"

namespace flowdlo::weights {
namespace {

constexpr std::string_view kPrefix = "links.";

}  // namespace

const Tensor& LinkWeights::at(std::string_view wanted) const {
  return named(tensors, fmt::format("{}{}", kPrefix, wanted));
}

std::vector<Expected> links_manifest() {
  const auto key = [](std::string_view name) { return fmt::format("{}{}", kPrefix, name); };
  return {{key("hidden"), {kLinkHidden, 1, kLinkInputs}},
          {key("bent"), {kLinkHidden}},
          {key("straight"), {kLinkInputs}}};
}

LinkWeights seeded_links(std::uint64_t seed) { return {"", seeded_noise(links_manifest(), seed)}; }

}  // namespace flowdlo::weights
