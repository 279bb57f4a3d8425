#include "eval/trial.hpp"

#include <algorithm>

namespace flowdlo::eval {

Outcome mean_of(const std::vector<Score>& scores) {
  Outcome outcome;
  const double share = scores.empty() ? 0 : 1.0 / static_cast<double>(scores.size());
  for (const Score& score : scores) {
    outcome.index_m += share * score.index_m;
    outcome.frechet_m += share * score.frechet_m;
    outcome.either_index_m += share * score.either_index_m;
    outcome.strand_errors += share * score.strand_errors;
    outcome.flips += score.flipped ? share : 0;
  }
  return outcome;
}

Outcome either_way(const Centerline& nodes, const Centerline& truth) {
  const Score forward = score(nodes, truth);
  const Score backward = score(reversed(nodes), truth);
  Outcome outcome;
  outcome.index_m = outcome.either_index_m = std::min(forward.index_m, backward.index_m);
  outcome.frechet_m = std::min(forward.frechet_m, backward.frechet_m);
  outcome.strand_errors = forward.strand_errors;
  return outcome;
}

const Account* Trial::account(const std::string& method) const {
  const auto found = accounts.find(method);
  return found == accounts.end() ? nullptr : &found->second;
}

const Outcome* Trial::of(const std::string& method) const {
  const auto found = methods.find(method);
  return found == methods.end() ? nullptr : &found->second;
}

}  // namespace flowdlo::eval
