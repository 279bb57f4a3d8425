// StrandField: what a small network sees of each pixel around the mask.
#pragma once

#include <memory>

#include "field/network.hpp"
#include "field/region.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::field {

struct StrandField {
  Region region;
  Channels channels;  ///< of the region; no rope far from the mask
  std::shared_ptr<const weights::LinkWeights> links{};  ///< what links its strands; or null
};

/// The rope's width in pixels of the frame, as the field has it in the middle; that of the region
/// where it shows too little.
[[nodiscard]] float width_px(const StrandField& seen);

/// A rope is at least so wide in the region for the field to part strands: narrower than believed.
inline constexpr float kNarrow = 0.82F;

/// Pixels of a region, and blocks of it near the mask, 75 MB and 0.4 s of one core, that are
/// looked at. A region beyond that is magnified less: down to a rope of kLeastWidth of its width.
inline constexpr int kMostRegionPixels = 1 << 22;
inline constexpr std::size_t kMostSeenBlocks = 1024;
inline constexpr float kLeastWidth = 0.5F;

/// A further look is worth its time where the width that the rope is magnified for, pixels of the
/// frame, is at most this share of the one before: a thin or long rope may be as large as it gets.
inline constexpr float kCloserBy = 0.88F;

/// And where a pixel of the frame was smaller than this in the region before: beyond that the frame
/// holds nothing more to see. Chosen on `wide` training scenes (docs/field.md).
inline constexpr float kAllSeenScale = 1.5F;

/// Whether `see` would look so much closer for a rope of that width, and see more, than a look did
/// that was magnified for `before_px` (Region::magnified_for_px).
[[nodiscard]] bool looks_closer(const Frame& frame, float rope_width_px, float before_px);

/// `rope_width_px` is the rope's width in the frame as far as it is known. Where the field itself
/// says that the rope is narrower than kNarrow of that, as in a mask that merges strands, it is
/// asked again at the width that it says, where that is closer. With `near_parts`, parts that come
/// much nearer to the camera than the middle are looked at once more, less magnified (NearParts).
/// `pool` as threads::share_out has it. Expects a valid frame with a mask. Fails with kNoEvidence
/// where the mask is empty or spreads over more than is looked at, or as Network::see does.
[[nodiscard]] Result<StrandField> see(const Frame& frame, float rope_width_px, Network& network,
                                      bool near_parts = false, threads::Pool* pool = nullptr);

}  // namespace flowdlo::field
