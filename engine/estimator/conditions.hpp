// Conditions: what one frame says before any model is asked, Eq. (3.11). The estimator and the
// trainer both take it from here, so that a model sees in use what it saw in training.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "estimator/hypotheses.hpp"
#include "estimator/see_axes.hpp"
#include "evidence/visible_points.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// How a frame is read.
struct ReadConfig {
  weights::PriorKind prior_kind = weights::PriorKind::kRefined;
  double rope_length_m = 0;             ///< 0: unknown
  std::vector<Eigen::Vector2f> ends{};  ///< as path::TraceConfig's
  std::optional<bool> closed{};         ///< likewise
  threads::Pool* pool = nullptr;        ///< as lift_all's

  /// `cleaned` as path::Glance has it; null: not known.
  [[nodiscard]] path::TraceConfig trace(
      const std::shared_ptr<const path::Region>& cleaned = {}) const {
    return {.rope_length_m = rope_length_m, .ends = ends, .closed = closed, .cleaned = cleaned};
  }
};

/// A rope's paths that are known already, and what a strand field shows where they were found.
struct Traced {
  path::Traversals paths;
  std::optional<field::FieldView> seen{};  ///< nothing where none was asked
};

/// A frame and its first reading.
struct Conditions {
  evidence::Cloud cloud;
  evidence::VisiblePoints visible;
  path::Traversals paths;
  std::vector<Hypothesis> hypotheses;             ///< best first; never empty
  std::shared_ptr<const path::Region> cleaned{};  ///< the frame's mask, where it is known; or null
  std::optional<field::Axes> axes{};  ///< of the strand field, which the paths run along; nothing:
                                      ///< they are the mask's, or were known already
  std::optional<field::FieldView> seen{};  ///< what a strand field shows; nothing without one
  bool of_mask = false;                    ///< the paths are those of the mask alone
  std::vector<std::uint8_t> believed{};    ///< the mask that was read; empty: the frame's
};

/// The first reading runs along `traced` where these paths are known already (else null), otherwise
/// along the axes that `see` shows, otherwise along the mask alone: where `see` is null or shows
/// nothing, of noise, of what is too short for its width, and where no hypothesis can be made of
/// the axes. What comes after has to go by the mask that was read (`read_frame`). Fills
/// evidence_ms, field_ms, path_ms and prior_ms of `timings`. Expects a valid frame. Fails with
/// kNoEvidence, or as path::glance, path::trace and lift_all do of the mask.
[[nodiscard]] Result<Conditions> gather(const Frame& frame, const ReadConfig& config,
                                        Timings& timings, const Traced* traced = nullptr,
                                        const SeeAxes& see = {});

/// `given` with the mask that `conditions`, which have to outlive it, were read by.
[[nodiscard]] Frame read_frame(const Frame& given, const Conditions& conditions);

}  // namespace flowdlo::estimator
