#include "path/link_network.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::path {
namespace {

static_assert(kLinkFeatures == weights::kLinkInputs);

// Negative logarithm of a likelihood, of the log odds against it.
float energy_of_odds(float against) {
  return std::max(against, 0.0F) + std::log1p(std::exp(-std::abs(against)));
}

}  // namespace

LinkFeatures link_features(const PairFeatures& pair, const LinkSide& from, const LinkSide& to) {
  LinkFeatures features{1, 0};
  auto next = std::copy(pair.begin(), pair.end(), features.begin() + 2);
  for (const LinkSide* const of : {&from, &to}) {
    next = std::copy(of->end.begin(), of->end.end(), next);
    next = std::copy(of->side.begin(), of->side.end(), next);
  }
  return features;
}

LinkFeatures stop_features(const EndFeatures& end) {
  LinkFeatures features{1, 1};
  std::copy(end.begin(), end.end(), features.begin() + 2 + kPairFeatures);
  return features;
}

float LinkNetwork::energy(const LinkFeatures& stop) const { return energy_of_odds(against_(stop)); }

float LinkNetwork::energy(const LinkFeatures& forth, const LinkFeatures& back) const {
  return energy_of_odds(0.5F * (against_(forth) + against_(back)));
}

}  // namespace flowdlo::path
