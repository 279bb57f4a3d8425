// Estimate: what a caller gets for one frame.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// Which branch of Eq. (3.33) produced the nodes.
enum class Source { kPrediction, kPrior };

/// The name without its k, in snake_case, as JSON, Python and ROS give it: "prior".
[[nodiscard]] constexpr const char* name_of(Source source) {
  return source == Source::kPrediction ? "prediction" : "prior";
}

/// Which of all candidates the nodes are.
enum class Origin {
  kFirstPrior,    ///< the best prior of the first reading: of the strand field; of the mask where
                  ///< there is no field or it shows nothing
  kRunnerUp,      ///< another prior of that reading
  kOtherReading,  ///< the prior of a way that only a further reading found
  kFrameBefore,   ///< Hints::previous: the rope lies where it lay
  kDraw,          ///< a draw of the model
};

/// "first_prior", "runner_up", "other_reading", "frame_before" or "draw".
[[nodiscard]] constexpr const char* name_of(Origin origin) {
  switch (origin) {
    case Origin::kFirstPrior:
      return "first_prior";
    case Origin::kRunnerUp:
      return "runner_up";
    case Origin::kOtherReading:
      return "other_reading";
    case Origin::kFrameBefore:
      return "frame_before";
    case Origin::kDraw:
      return "draw";
  }
  return "unknown";
}

/// The gate's view of one draw, Eq. (3.30)-(3.32).
struct DrawReport {
  bool accepted = false;
  bool finite = false;          ///< every coordinate of the draw is finite
  float length_ratio = 0;       ///< L(prediction) / L(prior), Eq. (3.31)
  float max_segment_share = 0;  ///< longest segment / L(prediction), Eq. (3.31)
  float mask_agreement = 0;     ///< S_M, Eq. (3.32), in [0, 1]
};

/// A traversal that lost to the returned one, and how close it came. Those that trail hopelessly
/// are not listed.
struct Alternative {
  Centerline nodes{};        ///< lifted like the prior, camera frame, metres; each turned by the
                             ///< hints for itself, as Estimate::nodes
  float score = 0;           ///< minus the cost of its path: higher is better, within a frame
  float mask_agreement = 0;  ///< S_M, Eq. (3.32)
};

/// Why an estimate is not to be trusted, whatever else speaks for it.
enum class Doubt {
  kNoRope,       ///< what the mask shows has not the shape of a rope
  kStrandsLeft,  ///< the nodes leave strands of the mask out
  kBareGap,      ///< the nodes cross plain background from one piece of the mask to another
  kGoesOn,       ///< depth shows the rope going on where the mask ends
  kNoDepth,      ///< the rope shows no depth: it is taken to lie on what is seen beside it
};

/// "no_rope", "strands_left", "bare_gap", "goes_on" or "no_depth".
[[nodiscard]] constexpr const char* name_of(Doubt doubt) {
  switch (doubt) {
    case Doubt::kNoRope:
      return "no_rope";
    case Doubt::kStrandsLeft:
      return "strands_left";
    case Doubt::kBareGap:
      return "bare_gap";
    case Doubt::kGoesOn:
      return "goes_on";
    case Doubt::kNoDepth:
      return "no_depth";
  }
  return "unknown";
}

/// Whether the mask, as it was put right, is one rope, the whole of it, and all of it explained by
/// the nodes. Widths are the rope's, as that mask has it.
struct OneRope {
  float explained = 0;        ///< [0, 1] share of the mask's area near the nodes
  float slender = 0;          ///< length of the nodes in the image, widths
  float sides = 0;            ///< [0, 1] share of the nodes on the mask beside which the mask ends
  float even = 0;             ///< [0, 1] share of these where the mask is as wide as the rope
  float left_over = 0;        ///< length of the strands that the nodes leave out, widths
  float off_mask = 0;         ///< [0, 1] share of the nodes off the mask where nothing hides them
  float bare_gap = 0;         ///< longest stretch of nodes on plain background, widths
  float goes_on = 0;          ///< how far the rope is seen going on beyond the mask, widths
  std::vector<Doubt> doubts;  ///< empty: none of this lowers `confidence`
};

/// What Config::budget_ms left no time for.
enum class LeftOut {
  kModel,     ///< its draws: the estimate is a prior
  kField,     ///< the strand field
  kReadings,  ///< further readings of a doubtful frame: the strand field closer; without a picture
              ///< also the mask alone
};

/// "model", "strand_field" or "readings".
[[nodiscard]] constexpr const char* name_of(LeftOut part) {
  switch (part) {
    case LeftOut::kModel:
      return "model";
    case LeftOut::kField:
      return "strand_field";
    case LeftOut::kReadings:
      return "readings";
  }
  return "unknown";
}

/// Milliseconds of each stage of one call. The stages sum to total_ms; beside_ms is in no sum.
struct Timings {
  double evidence_ms = 0;    ///< Sec. 3.2
  double field_ms = 0;       ///< what the strand field shows
  double path_ms = 0;        ///< Sec. 3.3, mask or field to ordered path
  double prior_ms = 0;       ///< Eq. (3.1)-(3.7), and comparing the traversals with the frame
  double readings_ms = 0;    ///< further readings, as far as they were waited for
  double mask_field_ms = 0;  ///< the field that the local features of Eq. (3.15) read
  double model_ms = 0;       ///< Eq. (3.26)-(3.28), upload and read-back included
  double gate_ms = 0;        ///< Eq. (3.30)-(3.33)
  double total_ms = 0;
  double beside_ms = 0;  ///< further readings, while mask field and model ran
  /// The parts of model_ms, as the device's clock saw them, in order of execution.
  std::vector<std::pair<std::string, double>> device_ms;
};

/// The most points that Estimate::curve() gives.
inline constexpr int kMostCurvePoints = 65536;

struct Estimate {
  /// [64, 3] end to end, camera frame, metres. Node 0 is the end of smaller x (then y, then z)
  /// where no hint says otherwise (hints.hpp). `support` and `sigma_m` have the same order.
  Centerline nodes{};
  std::array<std::uint8_t, kNodes> support{};  ///< h_i, Eq. (3.6): 1 where a visible point backs it
  /// [64] metres. Calibrated gate: 68 % of nodes are nearer to the truth than this and 95 % nearer
  /// than twice this, doubt about the traversal included. Thesis gate: not calibrated.
  std::array<float, kNodes> sigma_m{};
  int readings = 1;  ///< of the frame: strand field, closer, without a picture the mask alone; 1:
                     ///< the first left no doubt
  Source source = Source::kPrior;  ///< which branch of Eq. (3.33)
  Origin origin = Origin::kFirstPrior;
  int draw = -1;            ///< index of the returned draw; -1: the prior
  bool calibrated = false;  ///< the calibrated gate decided, not that of the thesis
  /// In [0, 1], whichever end comes first. Calibrated gate: the probability that the mean distance
  /// of `nodes` from the true ones, Eq. (4.1), is below 1 cm. Thesis gate: that `nodes` visit the
  /// rope in order and leave no loop out. Logistic models fitted on synthetic scenes: below 0.5
  /// another way through the mask, or a mask that hides the way, has to be reckoned with.
  /// A doubt about the mask (`one_rope`) leaves at most 0.25 of it. Of one rope of several it is
  /// the probability that the rope is one of the frame's as well (docs/ropes.md).
  float confidence = 0;
  bool closed = false;  ///< a ring without ends: node 63 lies where node 0 does
  OneRope one_rope;
  std::vector<LeftOut> left_out;          ///< for want of time; empty without Config::budget_ms
  float mask_agreement = 0;               ///< S_M of `nodes`, Eq. (3.32), in [0, 1]
  float prior_mask_agreement = 0;         ///< S_M of the prior
  std::vector<DrawReport> draws;          ///< one for each draw; none where the model was not asked
  std::vector<Alternative> alternatives;  ///< best first; may be empty
  bool reversed = false;  ///< by a hint the nodes run against the order that they have without one
  bool switched = false;  ///< by a hint another way through the mask was taken than without one;
                          ///< of `ends` and the length only as far as they outvote the gate
  Timings timings;

  /// [points, 3] of the smooth curve that the nodes stand for, uniform in its arclength, camera
  /// frame, metres, from the first node to the last: 64 chords cut small loops short. It goes
  /// through every node; nodes in one place count once, and if all are, so are the points. Fails
  /// with kBadInput where `points` is not 2..kMostCurvePoints or a node is not finite, and with
  /// kOutOfMemory.
  [[nodiscard]] FLOWDLO_EXPORT Result<std::vector<Point3>> curve(int points) const;
};

/// Where one rope passes over another, or over itself, in the image.
struct RopeCrossing {
  int over = 0;          ///< index in Ropes::ropes of the one nearer to the camera
  int under = 0;         ///< and of the other; the same where a rope passes over itself
  float over_at_m = 0;   ///< arclength from node 0 of `over`, metres
  float under_at_m = 0;  ///< arclength from node 0 of `under`, metres
  float apart_m = 0;     ///< by how much the one is nearer than the other along the ray, metres
};

/// What a caller gets for one frame of several ropes.
struct Ropes {
  std::vector<Estimate> ropes;          ///< longest first; never empty
  std::vector<RopeCrossing> crossings;  ///< by `over`, then `over_at_m`
  /// [height, width] which of `ropes` a pixel of the mask was given to, from 1; 0: none.
  std::vector<std::uint16_t> instances;
  double parting_ms = 0;  ///< telling the ropes apart
  double total_ms = 0;
};

/// What the strand field says of the part of a frame around the mask; docs/field.md.
struct SeenStrands {
  int width = 0;
  int height = 0;
  int first_u = 0;  ///< column and row of the frame's pixel in the part's corner
  int first_v = 0;
  float scale_u = 1;  ///< pixels of the field for one of the frame
  float scale_v = 1;
  std::vector<float> channels{};  ///< [10, height, width]; empty: there is no field
};

/// The tensors behind one estimate, for parity tests and for the curious. Shapes outermost first;
/// D draws, camera frame, metres unless said otherwise. No hint turns them: node 0 is the end of
/// smaller x.
struct Tensors {
  int draws = 0;
  int field_width = 0;                      ///< W / 2
  int field_height = 0;                     ///< H / 2
  std::vector<float> source;                ///< [D, 64, 3] x_0, normalised space
  std::vector<float> visible;               ///< [256, 3]
  std::vector<std::uint8_t> visible_valid;  ///< [256]
  std::vector<float> path;                  ///< [M, 2] pixels (u, v)
  std::vector<float> prior;                 ///< [64, 3]
  std::vector<std::uint8_t> support;        ///< [64]
  std::vector<float> draw_prior;            ///< [D, 64, 3]
  std::vector<std::uint8_t> draw_support;   ///< [D, 64]
  std::vector<float> prediction;            ///< [D, 64, 3] before the gate
  std::vector<float> mask_field;            ///< [4, H/2, W/2] mask, smoothed, u and v (half px)
  SeenStrands strands{};                    ///< whether there was doubt or not
};

}  // namespace flowdlo
