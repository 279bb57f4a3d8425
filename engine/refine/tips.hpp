// Tips: where a rope's tips lie beside the ends of its hypothesis, as a small network says it of
// what mask, depth and strand field show around each end. Fitted to scenes with truth by
// `flowdlo-lab tip-fit`, for the strand field whose file it is in.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "field/view.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "refine/strip.hpp"
#include "weights/bent_network.hpp"
#include "weights/tip_weights.hpp"

namespace flowdlo::refine {

/// Columns of an end; w is the rope's width there, r its radius.
enum TipColumn : std::size_t {
  kTipOne,          ///< 1
  kTipWidth,        ///< log2(w / 8 px) / 2
  kTipUnseen,       ///< along the rope to a node with support, 20 r
  kTipUnsupported,  ///< 1: the end has no support
  kTipSigma,        ///< log(sigma / r) / 2
  kTipSlope,        ///< cosine of the angle between the ray and the rope that goes on
  kTipBend,         ///< angle between the last two widths and the four before, radians
  kTipForeshort,    ///< how long the last two widths show, over how long they are
  kTipDistance,     ///< log of its depth, metres
  kTipAhead,        ///< [0, 1] how clearly the field shows a tip within a width ahead
  kTipLength,       ///< log(length / r) / 4 - 1
  kTipNoise,        ///< log of the depths' noise beside a millimetre, / 2
  kTipRadius,       ///< log(r / 4 mm)
  kTipColumns,
};

/// Then of each plane, on the axis, half a width beside it and a width beside it (the mean of both
/// sides), places from 1.5 widths before the end to 2.5 beyond it, straight on.
enum TipPlane : std::size_t {
  kTipMasked,    ///< 1 on the mask
  kTipMeasured,  ///< 1 where a depth was measured; -1 outside the image
  kTipDeeper,    ///< asinh of how much deeper than the end, in r, / 2; 0 where not measured
  kTipRope,      ///< field::kRope
  kTipLike,      ///< field::kTip
  kTipPlanes,
};
inline constexpr std::size_t kTipAsides = 3;
inline constexpr std::size_t kTipPlaces = 9;
inline constexpr std::size_t kTipFeatures = kTipColumns + kTipPlanes * kTipAsides * kTipPlaces;
using TipFeatures = std::array<float, kTipFeatures>;

/// Of the end at node 0, or at node 63. The curve has nodes in front of the camera and a radius.
[[nodiscard]] TipFeatures tip_features(const Curve& curve, bool last, const Frame& frame,
                                       const field::FieldView& seen);

/// A tip is not looked for farther than that before an end, or beyond it, widths of the rope. What
/// lies farther behind an occluder is no surer than a coin: of training scenes whose estimate is
/// less than 5 cm off, 0.336 cm with 2 widths, 0.341 with 4 and 0.353 with 8.
inline constexpr float kMostBefore = 1;
inline constexpr float kMostBeyond = 2;

/// What a network of tips says of a length in widths: asinh(length / kTipUnit).
inline constexpr float kTipUnit = 0.5F;

class TipNetwork {
 public:
  explicit TipNetwork(weights::TipWeights weights)
      : weights_(std::move(weights)), says_(weights_) {}
  TipNetwork(const TipNetwork&) = delete;  // its numbers are borrowed from itself
  TipNetwork& operator=(const TipNetwork&) = delete;

  /// How far beyond an end the tip lies, widths of the rope, within [-kMostBefore, kMostBeyond];
  /// 0 where what the network says is not finite.
  [[nodiscard]] float beyond(const TipFeatures& features) const;

 private:
  weights::TipWeights weights_;
  weights::BentNetwork says_;  ///< of these
};

/// The curve through the nodes, `beyond_m` longer at each end, straight on; shorter where negative,
/// but never by more than a third of it. Again 64 nodes, evenly along it.
[[nodiscard]] Centerline to_the_tips(const Centerline& nodes, const std::array<float, 2>& beyond_m);

}  // namespace flowdlo::refine
