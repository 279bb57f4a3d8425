// BelievedMask: the mask that a frame of one rope is read by. A segmenter's mask may be too wide,
// too narrow, coarse or aside; the strand field, which sees colour and depth as well, shows where
// the rope is.
#pragma once

#include <cstdint>
#include <vector>

#include "field/axes.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::estimator {

/// A mask and what the field takes for rope agree where they share at least this of all pixels that
/// either has. Chosen on 200 `wide` training scenes (docs/from-camera-to-nodes.md).
inline constexpr float kAgreeing = 0.8F;

/// How often a frame is looked at anew with the mask that the look before has shown.
inline constexpr int kMostBelieved = 2;

/// [height, width] 255 or 0: what the field takes for rope within half a rope's width of the
/// frame's mask, where the mask does not agree with it; empty: the frame's mask is believed as it
/// is. Farther away lie other ropes, which are not meant. Of a mask that is too wide only what the
/// field takes off it goes: it has measured the rope's colour and depth over too much that is none,
/// and is to be asked again. Where labels say what is beside the mask nothing is added to it.
[[nodiscard]] std::vector<std::uint8_t> believed_mask(const Frame& frame, float rope_width_px,
                                                      const field::Axes& seen);

}  // namespace flowdlo::estimator
