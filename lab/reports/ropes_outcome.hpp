// Ropes outcome: what a frame of several ropes gave, beside the truth of each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/rope_confidence.hpp"
#include "field/axes.hpp"
#include "field/network.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/estimator.hpp"
#include "gate/fitted.hpp"
#include "refine/network.hpp"
#include "scene/ropes.hpp"

namespace flowdlo::lab {

struct RopesOutcome {
  int found = 0;                   ///< ropes; 0: no answer
  int right = 0;                   ///< true ropes that one of the found visits in order, whole
  bool all_right = false;          ///< so many found as there are, and every one right
  std::vector<double> index_cm;    ///< [right] Eq. (4.1), in the better direction
  std::vector<double> confidence;  ///< [found] empty by paths alone
  std::vector<bool> rope_right;    ///< [found]
  std::vector<bool> rope_close;    ///< [found] right, and less than 1 cm off
  std::vector<estimator::ToldApart> told;  ///< [found] of parts that a judge saw
  std::vector<double> own_log_odds;        ///< [found] likewise
  int crossings = 0;                       ///< between true ropes that are right,
  int crossings_found = 0;                 ///< of these those that are told of,
  int crossings_right = 0;                 ///< and of these those with the right one above
  double parting_ms = 0;
  double total_ms = 0;
  std::string error;                     ///< where there is no answer
  std::vector<std::uint16_t> instances;  ///< as Ropes has them
  std::vector<Estimate> ropes;           ///< as found
  std::optional<field::Axes> axes;       ///< what the strand field showed
  double field_ms = 0;                   ///< until it did
};

/// What an estimator asks about each rope.
struct RopeJudge {
  gate::Fitted fitted;
  std::optional<refine::Network> refine;
};

/// How ropes are told apart.
struct RopesRun {
  int ropes = 0;                    ///< as Config::ropes
  bool labels = false;              ///< the true labels are given
  Estimator* model = nullptr;       ///< null: paths and refined priors, without the model
  field::Network* field = nullptr;  ///< by parts: what tells them apart beside the mask
  RopeJudge* judge = nullptr;       ///< by parts in any case, and each rope's is asked
};

[[nodiscard]] RopesOutcome outcome_of(const RopesScene& scene, const RopesRun& run);

}  // namespace flowdlo::lab
