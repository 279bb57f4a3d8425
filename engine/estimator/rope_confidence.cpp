#include "estimator/rope_confidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gate/one_rope.hpp"

namespace flowdlo::estimator {
namespace {

/// Log odds that an estimate is right and close: `at_none`, `each` for each unit of the lead, and
/// `of_estimate` for each of the log odds of its own confidence, or `of_ring` in place of those.
struct Odds {
  double at_none = 0;
  double each = 0;
  double of_estimate = 0;
  double of_ring = 0;
};

// In the order of Witness. Fitted by `flowdlo-lab ropes-report --odds` to 1,891 ropes of training
// scenes with a strand field, 874 by the mask alone and 780 with labels (docs/ropes.md).
constexpr std::array<Odds, 4> kOdds{{{-1.21, 0.24, 0.75, 0.43},
                                     {-1.32, 0.45, 0.64, 2.36},
                                     {-2.00, 0.46, 0.64, 2.36},
                                     {1.98, 0, 0.61, -0.44}}};
constexpr double kLeastShare = 0.01;            // an estimate's own confidence counts from here
constexpr double kMostShare = 1 - kLeastShare;  // to here

}  // namespace

double own_log_odds(double confidence) {
  const double share = std::clamp(confidence, kLeastShare, kMostShare);
  return std::log(share / (1 - share));
}

double rope_probability(const ToldApart& told, bool closed, double own) {
  const Odds& odds = kOdds.at(static_cast<std::size_t>(told.witness));
  const double of_estimate = closed ? odds.of_ring : odds.of_estimate * own_log_odds(own);
  const double logit = odds.at_none + odds.each * static_cast<double>(told.lead) + of_estimate;
  return 1 / (1 + std::exp(-logit));
}

float rope_confidence(const ToldApart& told, const Estimate& rope) {
  const double own = static_cast<double>(rope.confidence);
  const double probability = rope_probability(told, rope.closed, own);
  return gate::doubted(static_cast<float>(probability), rope.one_rope);
}

}  // namespace flowdlo::estimator
