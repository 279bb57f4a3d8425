// Sample: a patch as the network meets it: turned, scaled, with the faults of masks, sensors and
// lights, and what it should say of it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "field/channel.hpp"
#include "field/sight.hpp"
#include "strand/patch.hpp"

namespace flowdlo::strand {

/// How often, and by how much, a patch is spoiled. Shares are of all samples.
struct SpoilConfig {
  double width_spread = 0.12;      ///< of ln(width believed / true) where it is nearly right;
  double width_wrong_share = 0.4;  ///< elsewhere it is off by
  double width_wrong = 2;          ///< up to this factor either way
  double no_color = 0.15;
  double no_depth = 0.15;
  double mask_alone = 0.03;
  double grey = 0.25;
  double flat = 0;        ///< one colour everywhere, and the camera's noise
  double dark = 0;        ///< a few per cent of the light, and the camera's noise
  double moved = 0;       ///< blurred along a line of up to two widths of the rope
  double level = 0;       ///< one depth everywhere, as who has photographs alone makes it up
  double mask_depth = 0;  ///< depth on the mask alone, half of them without the rope's roundness
};

struct Sample {
  cv::Mat input;   ///< [size, size, field::kPlanes] f32
  cv::Mat target;  ///< [size, size, field::kChannels] f32
};

/// Square, `size_px` wide; the same for the same patch, seed and number.
[[nodiscard]] Sample sample_of(const Patch& patch, int size_px, std::uint64_t seed,
                               std::uint64_t number, const SpoilConfig& config = {});

}  // namespace flowdlo::strand
