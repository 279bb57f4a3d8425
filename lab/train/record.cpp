#include "train/record.hpp"

#include <algorithm>

#include "estimator/conditions.hpp"
#include "prior/prior.hpp"

namespace flowdlo::train {

Result<Record> make_record(const LabelledFrame& labelled, const RecordOptions& options) {
  if (auto valid = validate(labelled.frame); !valid) return valid.error();
  Timings timings;
  const auto conditions =
      estimator::gather(labelled.frame, {.prior_kind = options.prior_kind}, timings);
  if (!conditions) return conditions.error();

  Record record;
  record.index = labelled.index;
  record.scenario = labelled.scenario;
  record.difficulty = labelled.difficulty;
  record.intersection = labelled.intersection;
  record.camera = labelled.frame.intrinsics;
  record.mask = runs_of(labelled.frame);
  record.visible = conditions->visible;
  for (const auto& hypothesis : conditions->hypotheses) {
    record.priors.push_back(
        {hypothesis.prior.nodes, hypothesis.prior.support, static_cast<float>(hypothesis.score)});
  }
  if (options.with_depth) {
    record.depth_m.assign(labelled.frame.depth_m.begin(), labelled.frame.depth_m.end());
  }
  record.truth = labelled.truth;
  if (!prior::is_canonical(record.truth)) std::reverse(record.truth.begin(), record.truth.end());
  return record;
}

}  // namespace flowdlo::train
