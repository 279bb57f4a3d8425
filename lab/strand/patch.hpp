// Patch: part of a rendered frame with everything known about the strands in it: what the strand
// field is trained on, before it is turned, scaled, spoiled and rasterised.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::strand {

/// Who sees a point of a rope's axis.
enum class Seen : std::uint8_t {
  kNo,     ///< hidden by another thing, or beyond the image
  kUnder,  ///< hidden by a strand of rope
  kYes,
};

/// A point of a rope's axis as the camera sees it; pixels of the patch.
struct AxisPoint {
  float u = 0;
  float v = 0;
  float radius_px = 0;
  float depth_m = 0;       ///< of the axis
  float along_widths = 0;  ///< arclength from the rope's first end, in its widths
  Seen seen = Seen::kYes;
};

/// A rope, or a stretch of one that runs through the patch, about half a pixel a step.
struct Strand {
  int rope = 0;
  std::vector<AxisPoint> points;
  bool begins = false;  ///< its first point is an end of the rope
  bool ends = false;    ///< its last point is
};

struct Patch {
  int width = 0;
  int height = 0;
  float frame_scale = 1;                ///< pixels of the patch a pixel of the frame, at most 1
  float focal_px = 0;                   ///< in pixels of the patch
  float rope_px = 0;                    ///< the rope's width in the middle of the patch
  std::vector<std::uint8_t> color_bgr;  ///< [height, width, 3]
  std::vector<std::uint8_t> mask;       ///< [height, width] share of a pixel, of 255
  std::vector<std::uint16_t> depth;     ///< [height, width] in synth::kDepthScale_m, 0: none
  std::vector<Strand> strands;
};

struct PatchConfig {
  int each = 3;              ///< patches of a frame
  double half_widths = 15;   ///< from its middle to its border, in widths of the rope
  int least_half_px = 40;    ///< pixels of the frame
  double most_rope_px = 10;  ///< a wider rope is shrunk to that
  double near_share = 0.55;  ///< of patches around places where strands come near each other
  double end_share = 0.2;    ///< around ends
  double hidden_share = 0;   ///< around places where a strand goes behind another thing: no ends
};

/// A frame of `index`, and patches of it. `as` says of what kind its ropes and its depth are; what
/// else it says is not looked at. Deterministic. Fails as synth::make_frame does.
[[nodiscard]] Result<std::vector<Patch>> patches_of(synth::Split split, synth::Part part,
                                                    std::uint64_t seed, std::uint64_t index,
                                                    const PatchConfig& config = {},
                                                    const synth::Render& as = {});

/// A plain drawn frame of the training part: every other one's is of a single rope, the others' of
/// two to five. With dense truth. Deterministic.
[[nodiscard]] synth::SyntheticFrame drawn_training_frame(std::uint64_t seed, std::uint64_t index);

/// Patches of it. Deterministic.
[[nodiscard]] std::vector<Patch> drawn_patches_of(std::uint64_t seed, std::uint64_t index,
                                                  const PatchConfig& config = {});

/// The strands of a whole frame in its own pixels, as a field is to see them: a held end, one that
/// is hidden for a few widths by what holds the rope, is where it is seen last.
[[nodiscard]] std::vector<Strand> strands_of(const synth::SyntheticFrame& frame);

/// The same from tip to tip, held ends too.
[[nodiscard]] std::vector<Strand> whole_strands_of(const synth::SyntheticFrame& frame);

}  // namespace flowdlo::strand
