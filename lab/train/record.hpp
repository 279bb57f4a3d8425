// Record: one frame as the trainer sees it: what the engine would feed its model, and the truth.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "evidence/visible_points.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "train/mask_runs.hpp"
#include "weights/variant.hpp"

namespace flowdlo::train {

/// How hard a scene is for geometry; decides about sampling weights and validation tables.
enum class Difficulty : std::uint8_t { kEasy, kMiddle, kHard };

/// A frame with truth, whatever made it. `frame` views pixels that the caller keeps.
struct LabelledFrame {
  Frame frame;
  Centerline truth{};
  std::string scenario;
  Difficulty difficulty = Difficulty::kMiddle;
  bool intersection = false;  ///< sampled twice as often, Sec. 4.1.3
  std::uint64_t index = 0;
};

/// A traversal's prior as the engine feeds it to a draw.
struct PriorState {
  Centerline nodes{};                          ///< X_prior, camera frame, canonical direction
  std::array<std::uint8_t, kNodes> support{};  ///< h_i
  float score = 0;                             ///< estimator::Hypothesis::score

  friend bool operator==(const PriorState&, const PriorState&) = default;
};

struct Record {
  std::uint64_t index = 0;
  std::string scenario;
  Difficulty difficulty = Difficulty::kMiddle;
  bool intersection = false;
  Intrinsics camera;
  MaskRuns mask;  ///< of the whole frame; its size is the frame's
  evidence::VisiblePoints visible;
  std::vector<PriorState> priors;  ///< best first, runners-up after it; never empty
  std::vector<float> depth_m;      ///< [height, width] for 8 local channels, otherwise empty
  Centerline truth{};              ///< canonical direction, Sec. 3.3
};

struct RecordOptions {
  weights::PriorKind prior_kind = weights::PriorKind::kRefined;
  bool with_depth = false;  ///< keep the depth image, for the residual of Eq. (3.16)
};

/// Runs the engine's own stages. Fails as estimator::gather does: such a frame has no estimate
/// either, so that there is nothing to learn from it.
[[nodiscard]] Result<Record> make_record(const LabelledFrame& labelled,
                                         const RecordOptions& options);

}  // namespace flowdlo::train
