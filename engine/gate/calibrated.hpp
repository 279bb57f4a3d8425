// The calibrated gate: the candidate that a score fitted on synthetic scenes prefers, how likely it
// is to be close to the truth, and how far its nodes may be off.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "gate/candidate.hpp"
#include "gate/candidate_features.hpp"
#include "gate/network.hpp"
#include "gate/node_error.hpp"
#include "gate/node_features.hpp"

namespace flowdlo::gate {

/// A mean index error below this, Eq. (4.1), is what the probability promises.
inline constexpr double kCloseError_m = 0.01;

/// What flowdlo-lab gate-fit fits, for each model and each strand field: gate/fitted.hpp.
struct GateWeights {
  std::array<double, kDrawFeatures> draw{};
  double draw_margin = 0;                          ///< score above which a draw replaces its prior
  Network<kHypothesisFeatures, 1, 32> hypothesis;  ///< score of what a hypothesis would return
  double hypothesis_margin = 0;  ///< score by which a runner-up has to beat the best hypothesis
  Network<kClosenessFeatures, 1> closeness;  ///< log odds that the winner is close
  Network<kNodeFeatures, NodeError::kNumbers, 16> node_error;
  double sigma_share = 0;  ///< probability of being off by less than two sigma_m
};

struct Choice {
  std::size_t chosen = 0;  ///< index among the candidates; ties go to the lower one
  double probability = 0;  ///< [0, 1] that its index error is below kCloseError_m, either way round
  std::array<float, kNodes> sigma_m{};  ///< 68 % of nodes are off by less, 95 % by less than twice
  bool switched = false;  ///< without what is known beside the frame it would go another way
};

/// What the probability becomes by what is known beside the frame; sigma goes by that. Null: it
/// stays. Of a rope that has one, a ring has no ends that could be a guess: that it is one was
/// told.
using InAll = std::function<double(double)>;

/// What is known beside the frame. It decides with the scores; the probability of the chosen one is
/// the frame's alone.
struct Beside {
  std::vector<double> log_prior{};   ///< [candidates] what speaks for each; empty: nothing does
  std::optional<Candidate> guest{};  ///< a hypothesis that the frame did not bring forth, as if it
                                     ///< came after the candidates; they do not count it
  double guest_log_prior = 0;
  InAll in_all{};
};

/// [hypotheses] index of the candidate that each would return: its draw of highest score where that
/// passes the margin, ties to the lower index, otherwise its prior.
[[nodiscard]] std::vector<std::size_t> returned_by(std::span<const Candidate> candidates,
                                                   const GateWeights& weights);

/// The score of a candidate as what its hypothesis would return; higher is better. The lowest there
/// is where anything is not finite.
[[nodiscard]] double hypothesis_score(std::span<const Candidate> candidates, std::size_t index,
                                      const GateWeights& weights);

/// Which of the scores is taken: the highest where it leads the first by more than the margin,
/// otherwise the first.
[[nodiscard]] std::size_t preferred(std::span<const double> scores, double margin);

/// Score by which hypothesis `chosen` leads the best that runs elsewhere, which can be negative;
/// `returned` and `scores` are [hypotheses].
[[nodiscard]] double lead_elsewhere(std::span<const Candidate> candidates,
                                    std::span<const std::size_t> returned,
                                    std::span<const double> scores, std::size_t chosen);

/// `candidates` is not empty, begins with the best prior, and lists a prior at the index of each
/// hypothesis. The guest's index is the number of candidates.
[[nodiscard]] Choice choose_calibrated(std::span<const Candidate> candidates,
                                       const GateWeights& weights, const Beside& beside = {});

}  // namespace flowdlo::gate
