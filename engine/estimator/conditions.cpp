#include "estimator/conditions.hpp"

#include <cstdint>
#include <utility>

#include "estimator/believed_mask.hpp"
#include "estimator/stopwatch.hpp"
#include "gate/one_rope.hpp"
#include "path/strand_reading.hpp"

namespace flowdlo::estimator {
namespace {

Error no_evidence() {
  return {ErrorCode::kNoEvidence,
          "Frame: expected depth on the mask or beside it, got no mask pixel with a depth above "
          "1e-6 m, and too little beside the mask to tell what the rope lies on; check the mask, "
          "and that depth is in metres and aligned to it"};
}

/// Paths and hypotheses of `conditions`, where the paths have any.
Result<void> lift(path::Traversals paths, const Frame& frame, const ReadConfig& config,
                  Conditions& conditions) {
  auto hypotheses =
      lift_all(paths, conditions.cloud, conditions.visible, frame, config.prior_kind, config.pool);
  if (!hypotheses) return hypotheses.error();
  conditions.paths = std::move(paths);
  conditions.hypotheses = *std::move(hypotheses);
  return {};
}

void show(const Frame& frame, Conditions& conditions) {
  conditions.cloud = evidence::unproject(frame);  // Sec. 3.2
  conditions.visible = evidence::visible_points(conditions.cloud);
}

/// What `see` shows of the frame, once it shows a mask that it agrees with or was asked often
/// enough: fills `cleaned` and `believed`. Fails as path::glance does.
Result<std::optional<field::Axes>> look(const Frame& given, const SeeAxes& see,
                                        Conditions& conditions) {
  std::optional<field::Axes> axes;
  std::vector<std::uint8_t> mask;
  Frame frame = given;
  for (int believed = 0;; ++believed) {
    const auto glance = path::glance(frame);
    if (!glance && !axes) return glance.error();
    if (!axes) conditions.cleaned = glance->cleaned;
    // Of noise a field shows noise, and the longer the more there is of it; of a disc nothing.
    const bool worth =
        glance && !glance->filtered && glance->slender >= gate::OneRopeLimits{}.slender;
    auto seen = worth ? see(frame, glance->rope_width_px) : std::nullopt;
    if (!seen) break;
    axes = std::move(seen);
    conditions.cleaned = glance->cleaned;
    conditions.believed = std::move(mask);
    if (believed == kMostBelieved) break;
    mask = believed_mask(frame, glance->rope_width_px, *axes);
    if (mask.empty()) break;
    frame.mask = mask;
  }
  return axes;
}

/// Reads the frame along the axes that `see` shows. Whether there are any, and hypotheses of them;
/// fails as path::glance does.
Result<bool> read_seen(const Frame& given, const ReadConfig& config, const SeeAxes& see,
                       Timings& timings, Conditions& conditions) {
  Stopwatch stage;
  auto axes = look(given, see, conditions);
  stage.lap(timings.field_ms);
  if (!axes) return axes.error();
  if (!*axes) return false;
  const Frame frame = read_frame(given, conditions);
  if (!conditions.believed.empty()) show(frame, conditions);
  stage.lap(timings.evidence_ms);
  if (conditions.cloud.points_cam.empty()) return false;
  auto paths = path::trace_strands(frame, **axes, config.trace(conditions.cleaned));
  stage.lap(timings.path_ms);
  const auto lifted =
      paths ? lift(*std::move(paths), frame, config, conditions) : Result<void>(paths.error());
  stage.lap(timings.prior_ms);
  if (!lifted) {
    throw_what_ends_a_frame(lifted.error());
    return false;
  }
  conditions.seen = std::exchange((*axes)->view, {});
  conditions.axes = *std::move(axes);
  return true;
}

}  // namespace

Result<Conditions> gather(const Frame& frame, const ReadConfig& config, Timings& timings,
                          const Traced* traced, const SeeAxes& see) {
  Stopwatch stage;
  Conditions conditions;
  show(frame, conditions);
  if (conditions.cloud.points_cam.empty()) return no_evidence();
  stage.lap(timings.evidence_ms);
  if (traced == nullptr && see) {
    const auto seen = read_seen(frame, config, see, timings, conditions);
    if (!seen) return seen.error();
    if (*seen) return conditions;
    if (!conditions.believed.empty()) {  // nothing was made of it: the frame is read as it came
      conditions.believed.clear();
      conditions.cleaned = nullptr;
      show(frame, conditions);
    }
  }
  Stopwatch rest;
  auto paths = traced != nullptr
                   ? Result<path::Traversals>(traced->paths)
                   : path::trace(frame, config.trace(conditions.cleaned));  // Sec. 3.3
  if (traced == nullptr) rest.lap(timings.path_ms);
  if (!paths) return paths.error();
  const auto lifted = lift(*std::move(paths), frame, config, conditions);
  rest.lap(timings.prior_ms);
  if (!lifted) return lifted.error();
  conditions.of_mask = traced == nullptr;
  if (traced != nullptr) conditions.seen = traced->seen;
  return conditions;
}

Frame read_frame(const Frame& given, const Conditions& conditions) {
  Frame frame = given;
  if (!conditions.believed.empty()) frame.mask = conditions.believed;
  return frame;
}

}  // namespace flowdlo::estimator
