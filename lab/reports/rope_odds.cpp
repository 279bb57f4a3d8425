#include "reports/rope_odds.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "estimator/opening.hpp"
#include "reference/program.hpp"
#include "survey/choice_fit.hpp"
#include "survey/table.hpp"
#include "weights/kept_file.hpp"
#include "weights/location.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kRidge = 0.1;
constexpr std::array kNames{"none", "agrees", "differs", "a label"};  // in the order of Witness

// Features of the fit: two of each witness, then the estimate's own log odds, then being a ring.
constexpr Eigen::Index kWitnesses = 4;
constexpr Eigen::Index kOwn = 2 * kWitnesses;
constexpr Eigen::Index kRing = kOwn + 1;
constexpr Eigen::Index kFeatures = kRing + 1;

}  // namespace

Result<RopeJudge> open_judge(const Config& config) {
  const auto location = weights::located(config.weights);
  auto model = weights::keep(location.model);
  if (!model) return model.error();
  auto field = estimator::open_field(config, location.field);
  if (!field) return field.error();
  auto fitted = estimator::open_gate(config, *model, field->calibration);
  if (!fitted) return fitted.error();
  if (!*fitted) {
    return Error{ErrorCode::kBadWeights,
                 "ropes-report --odds: expected weights with a calibrated gate, got some without; "
                 "take others"};
  }
  return RopeJudge{**std::move(fitted), std::move(field->refine)};
}

void RopeOdds::add(const RopesOutcome& outcome) {
  for (std::size_t i = 0; i < outcome.own_log_odds.size(); ++i) {
    const auto& told = outcome.told[i];
    rows_.push_back({told.witness, static_cast<double>(told.lead), outcome.own_log_odds[i],
                     outcome.ropes[i].closed, outcome.rope_close[i]});
  }
}

void RopeOdds::print() const {
  if (rows_.empty()) return;
  std::vector<survey::Choice> choices;
  std::array<int, kWitnesses> ropes{};
  int rings = 0;
  for (const Row& row : rows_) {
    const auto witness = static_cast<std::size_t>(row.witness);
    ++ropes[witness];
    rings += row.closed ? 1 : 0;
    Eigen::MatrixXd options = Eigen::MatrixXd::Zero(2, kFeatures);
    const auto first = static_cast<Eigen::Index>(2 * witness);
    options(0, first) = 1;
    options(0, first + 1) = row.lead;
    options(0, row.closed ? kRing : kOwn) = row.closed ? 1 : row.own;
    choices.push_back({options, row.close ? 0 : 1});
  }
  const Eigen::VectorXd odds = survey::fit(choices, kFeatures, kRidge);
  survey::Table table({"a second reading", "ropes", "log odds of being close"});
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    if (ropes[k] == 0) continue;
    const auto first = static_cast<Eigen::Index>(2 * k);
    table.add({kNames[k], std::to_string(ropes[k]),
               fmt::format("{:.2f} {:+.2f} lead", odds[first], odds[first + 1])});
  }
  fmt::print("{}and {:+.2f} of each of the estimate's own log odds; of {} rings {:+.2f} instead\n",
             table.text(), odds[kOwn], rings, odds[kRing]);
}

}  // namespace flowdlo::lab
