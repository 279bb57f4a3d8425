#include "field/strand_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "field/channel.hpp"
#include "field/sight.hpp"
#include "geometry/mask_box.hpp"

namespace flowdlo::field {
namespace {

constexpr float kSure = 0.5F;            // centre and rope that are asked for the width
constexpr std::size_t kLeastAsked = 30;  // pixels of them
constexpr int kMostLooks = 3;            // each at a smaller width

/// The rope's width over kRope_px as the field has it, in the middle; 1 where it does not say.
float seen_width(const cv::Mat& field) {
  std::vector<float> widths;
  for (int v = 0; v < field.rows; ++v) {
    for (int u = 0; u < field.cols; ++u) {
      const float* const at = field.ptr<float>(v) + u * kChannels;
      if (at[kCentre] > kSure && at[kRope] > kSure) widths.push_back(at[kWidth]);
    }
  }
  if (widths.size() < kLeastAsked) return 1;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return std::exp2(*middle);
}

Error too_large(const Region& region) {
  return {ErrorCode::kNoEvidence,
          fmt::format(
              "field: expected the mask of a rope, at most {} pixels and {} blocks with the "
              "rope {} px wide, got one of {} x {} pixels; check the segmentation",
              kMostRegionPixels, kMostSeenBlocks, kRope_px, region.size.width, region.size.height)};
}

/// Fails with kNoEvidence where the region is too large to be looked at.
Result<cv::Mat> see_region(const Frame& frame, const Region& region, Network& network) {
  if (region.size.area() > kMostRegionPixels) return too_large(region);
  auto sight = std::make_optional(field::look(frame, region));
  const BlockMap blocks = blocks_near(sight->mask);
  if (blocks.blocks.size() > kMostSeenBlocks) return too_large(region);
  const cv::Mat input = input_of(*sight);
  sight.reset();  // six images of the region's size
  return network.see(input, blocks);
}

}  // namespace

float width_px(const StrandField& seen) {
  const float scale = std::sqrt(seen.region.scale.x() * seen.region.scale.y());
  return seen_width(seen.channels) * kRope_px / scale;
}

Result<StrandField> see(const Frame& frame, float rope_width_px, Network& network) {
  const geometry::MaskBox mask = geometry::mask_box(frame);
  const cv::Rect box(mask.left, mask.top, mask.width, mask.height);
  if (box.empty()) {
    return Error{ErrorCode::kNoEvidence,
                 "field: expected a mask, got none; check the segmentation"};
  }
  StrandField result;
  float width_px = rope_width_px;
  bool shrunk = false;
  for (int look = 0; look < kMostLooks; ++look) {
    result.region = region_around(box, {frame.width, frame.height}, width_px);
    auto seen = see_region(frame, result.region, network);
    if (!seen && seen.error().code == ErrorCode::kNoEvidence && !shrunk) {  // as small as it may be
      shrunk = true;
      width_px /= kNarrow;
      continue;
    }
    if (!seen) return seen.error();
    result.channels = *std::move(seen);
    const float share = seen_width(result.channels);
    const bool magnified = kRope_px / width_px >= kMostScale;
    if (share >= kNarrow || magnified || shrunk) break;
    width_px *= share;
  }
  return result;
}

}  // namespace flowdlo::field
