// Channel: what the strand field says of each pixel.
#pragma once

#include <array>

#include "field/block_image.hpp"

namespace flowdlo::field {

/// In the network's order. Directions are those of a line, without sense: the cosine and sine of
/// twice the angle from u towards v.
enum Channel {
  kCentre,  ///< nearness to the axis of the strand that shows: exp(-(distance / (w / 4))^2)
  kCos,     ///< direction of that strand
  kSin,
  kTip,       ///< nearness to an end that shows, or that something holds, where it is seen last:
              ///< exp(-(distance / (0.7 w))^2)
  kUnder,     ///< nearness to the axis of a strand that runs below the one that shows
  kUnderCos,  ///< direction of that one
  kUnderSin,
  kWidth,  ///< log2 of the strand's width w over kRope_px
  kRope,   ///< 1 on a rope
  kEdge,   ///< 1 where a strand that passes over another one ends
  kChannels
};

inline constexpr float kCentreWidths = 0.25F;  ///< in kCentre and kUnder
inline constexpr float kTipWidths = 0.7F;      ///< in kTip

/// What is said of each pixel of a region; nothing where its block was not computed.
using Channels = BlockImage<std::array<float, kChannels>>;

}  // namespace flowdlo::field
