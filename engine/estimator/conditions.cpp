#include "estimator/conditions.hpp"

#include <utility>

#include "estimator/stopwatch.hpp"

namespace flowdlo::estimator {
namespace {

Error no_evidence() {
  return {ErrorCode::kNoEvidence,
          "Frame: expected depth on the mask, got no mask pixel with a depth above 1e-6 m; check "
          "the mask, and that depth is in metres and aligned to it"};
}

}  // namespace

Result<Conditions> gather(const Frame& frame, double rope_length_m, weights::PriorKind kind,
                          Timings& timings, const std::vector<Eigen::Vector2f>& ends,
                          const path::Traversals* traced) {
  Stopwatch stage;
  Conditions conditions;
  conditions.cloud = evidence::unproject(frame);  // Sec. 3.2
  if (conditions.cloud.points_cam.empty()) return no_evidence();
  conditions.visible = evidence::visible_points(conditions.cloud);
  stage.lap(timings.evidence_ms);

  auto paths =
      traced != nullptr
          ? Result<path::Traversals>(*traced)
          : path::trace(frame, {.rope_length_m = rope_length_m, .ends = ends});  // Sec. 3.3
  stage.lap(timings.path_ms);
  if (!paths) return paths.error();
  conditions.paths = *std::move(paths);

  auto hypotheses = lift_all(conditions.paths, conditions.cloud, conditions.visible, frame, kind);
  stage.lap(timings.prior_ms);
  if (!hypotheses) return hypotheses.error();
  conditions.hypotheses = *std::move(hypotheses);
  return conditions;
}

}  // namespace flowdlo::estimator
