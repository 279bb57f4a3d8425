// Trial: everything that one frame contributes to the tables.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/metrics.hpp"
#include "eval/scene_info.hpp"
#include "flowdlo/estimate.hpp"

namespace flowdlo::eval {

/// A method's outcome: the mean over its draws where it has several, as Sec. 4.1.3 reports it.
struct Outcome {
  double index_m = 0;
  double frechet_m = 0;
  double either_index_m = 0;
  double strand_errors = 0;
  double flips = 0;  ///< share of the draws
};

/// The mean of several scores; of none: all zero.
[[nodiscard]] Outcome mean_of(const std::vector<Score>& scores);

/// Eq. (4.3): each error in the direction in which it is smaller.
[[nodiscard]] Outcome either_way(const Centerline& nodes, const Centerline& truth);

/// Share of nodes, in [0, 1], that lie within one and within two `sigma_m` of the true node
/// (distances in space): 0.68 and 0.95 when sigma_m is calibrated.
struct SigmaCoverage {
  double one = 0;
  double two = 0;
};

/// How a method fared apart from its errors, which frames without truth have as well.
struct Account {
  std::string failure;  ///< why nothing valid came out, in words that can be counted
  bool output = false;  ///< nodes came out, valid or not
  int draws = 1;
  int accepted = 0;           ///< by the gate of Eq. (3.31)-(3.33)
  double mask_agreement = 0;  ///< S_M, Eq. (3.32), mean over the draws

  [[nodiscard]] bool valid() const { return failure.empty(); }
};

struct Trial {
  std::string name;
  std::filesystem::path folder;
  std::string data_set;  ///< name of the folder that holds the frame's
  SceneInfo scene;
  std::string failure;  ///< why there is no estimate; empty when there is one
  bool with_truth = false;
  /// By method: "prior", "refined", "model" (every draw), "estimate" (after the gate), "oracle"
  /// (the best of draws and prior), "hybrid" (every draw, or the prior in the place of one that the
  /// gate rejects), and those of the contenders. A method that gave nothing valid is missing.
  std::map<std::string, Outcome> methods;

  /// By method, as far as it was run; "model" and "prior" are those of the estimate.
  std::map<std::string, Account> accounts;
  /// By method, one a draw, camera frame, in its published direction; rounded, no NaN.
  std::map<std::string, std::vector<Centerline>> curves;

  Centerline nodes{};  ///< the estimate
  Centerline truth{};  ///< in the estimate's better direction; where `with_truth`

  Source source = Source::kPrior;
  int accepted_draws = 0;
  int draws = 0;
  double confidence = 0;
  double mask_agreement = 0;
  double total_ms = 0;
  SigmaCoverage sigma;

  [[nodiscard]] bool answered() const { return failure.empty(); }
  [[nodiscard]] const Outcome* of(const std::string& method) const;
  [[nodiscard]] const Account* account(const std::string& method) const;
};

}  // namespace flowdlo::eval
