#include "eval/trial.hpp"

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

const Outcome* Trial::of(const std::string& method) const {
  const auto found = methods.find(method);
  return found == methods.end() ? nullptr : &found->second;
}

}  // namespace flowdlo::eval
