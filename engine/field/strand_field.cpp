#include "field/strand_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "field/channel.hpp"
#include "field/near_parts.hpp"
#include "field/sight.hpp"
#include "geometry/mask_box.hpp"

namespace flowdlo::field {
namespace {

constexpr float kSure = 0.5F;            // centre and rope that are asked for the width
constexpr std::size_t kLeastAsked = 30;  // pixels of them
constexpr int kMostLooks = 3;            // each at a smaller width
constexpr float kSpare = 1.02F;          // a region that has to fit is smaller by this,
constexpr int kMostFits = 6;             // and then once more

/// The rope's width over kRope_px as the field has it, in the middle; 1 where it does not say.
float seen_width(const Channels& field) {
  std::vector<float> widths;
  field.for_rows([&](int, int, const auto* at, int count) {
    for (int i = 0; i < count; ++i) {
      if (at[i][kCentre] > kSure && at[i][kRope] > kSure) widths.push_back(at[i][kWidth]);
    }
  });
  if (widths.size() < kLeastAsked) return 1;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return std::exp2(*middle);
}

bool closer(const Region& region, float before_px) {
  return region.magnified_for_px() <= kCloserBy * before_px;
}

Error too_large(const image::Rect& box, float rope_width_px) {
  return {ErrorCode::kNoEvidence,
          fmt::format("field: expected the mask of a rope, at most {} pixels and {} blocks near it "
                      "with the rope {} px wide, got one of {} x {} pixels and a rope of {:.1f}; "
                      "check the segmentation",
                      kMostRegionPixels, kMostSeenBlocks, kLeastWidth * kRope_px, box.width,
                      box.height, rope_width_px)};
}

/// A region, and which blocks of it are looked at.
struct View {
  Region region;
  std::shared_ptr<const BlockMap> blocks;
};

/// The region for a rope of `width_px`, or magnified less as far as kMostRegionPixels takes, which
/// `width_px` tells then; nothing where that is beyond what strands of a rope of `least_px` can be
/// parted with.
std::optional<Region> fitted(const Frame& frame, const image::Rect& box, float least_px,
                             float& width_px) {
  for (int fit = 0; fit < kMostFits && width_px * kLeastWidth <= least_px; ++fit) {
    const Region region = region_around(box, {frame.width, frame.height}, width_px);
    const double pixels = static_cast<double>(region.size.width) * region.size.height;
    if (pixels <= kMostRegionPixels) return region;
    width_px *= kSpare * static_cast<float>(std::sqrt(pixels / kMostRegionPixels));
  }
  return std::nullopt;
}

/// The width that a rope is magnified for where it can be.
float least_width_px(float rope_width_px) { return std::max(rope_width_px, kRope_px / kMostScale); }

/// The region at the rope's width, or magnified less as far as it takes and strands can still be
/// parted. Fails with kNoEvidence where it would still be too large to be looked at.
Result<View> view_of(const Frame& frame, const image::Rect& box, float rope_width_px,
                     threads::Pool* pool) {
  const float least_px = least_width_px(rope_width_px);
  float width_px = least_px;
  for (int fit = 0; fit < kMostFits; ++fit) {
    const auto region = fitted(frame, box, least_px, width_px);
    if (!region) break;
    BlockMap blocks = blocks_near(frame, *region, pool);
    const auto seen = static_cast<float>(blocks.blocks.size());
    if (blocks.blocks.size() <= kMostSeenBlocks) {
      return View{*region, std::make_shared<const BlockMap>(std::move(blocks))};
    }
    width_px *= kSpare * seen / static_cast<float>(kMostSeenBlocks);  // as many as it is long
  }
  return too_large(box, rope_width_px);
}

/// What the network says of `wanted` blocks of a view, all of which tell of the rope.
Result<Channels> look_at(const Frame& frame, const View& view,
                         const std::shared_ptr<const BlockMap>& wanted, Network& network,
                         threads::Pool* pool) {
  const NearSight sight = field::look(frame, view.region, view.blocks, pool);
  const Input input(sight);
  const auto planes_of = [&](const image::Point& block, PlanesOfPixel* to) {
    input.planes_of(static_cast<std::size_t>(view.blocks->number_of(block)), to);
  };
  return network.see(view.region.size, wanted, planes_of, pool);
}

/// Looks once more, less magnified, where the rope is much wider than `seen` expects.
Result<void> look_at_near_parts(const Frame& frame, const image::Rect& box, Network& network,
                                StrandField& seen, threads::Pool* pool) {
  const float octaves = wide_octaves(seen.channels);
  if (octaves <= 0) return {};
  auto view = view_of(frame, box, std::exp2(octaves) * seen.region.magnified_for_px(), pool);
  if (!view) return view.error();
  const NearParts parts(seen.channels, octaves);
  const auto blocks =
      std::make_shared<const BlockMap>(parts.needed(*view->blocks, view->region, seen.region));
  if (blocks->blocks.empty()) return {};
  auto channels = look_at(frame, *view, blocks, network, pool);
  if (!channels) return channels.error();
  blend(seen, {view->region, *std::move(channels), nullptr}, parts, octaves);
  return {};
}

}  // namespace

float width_px(const StrandField& seen) {
  return seen_width(seen.channels) * seen.region.magnified_for_px();
}

bool looks_closer(const Frame& frame, float rope_width_px, float before_px) {
  if (kAllSeenScale * before_px <= kRope_px) return false;
  const image::Rect box = geometry::mask_box(frame);
  if (box.empty()) return false;
  const float least_px = least_width_px(rope_width_px);
  float width_px = least_px;
  const auto region = fitted(frame, box, least_px, width_px);
  return region && closer(*region, before_px);
}

Result<StrandField> see(const Frame& frame, float rope_width_px, Network& network, bool near_parts,
                        threads::Pool* pool) {
  const image::Rect box = geometry::mask_box(frame);
  if (box.empty()) {
    return Error{ErrorCode::kNoEvidence,
                 "field: expected a mask, got none; check the segmentation"};
  }
  StrandField result;
  float width_px = rope_width_px;
  for (int look = 0; look < kMostLooks; ++look) {
    auto view = view_of(frame, box, width_px, pool);
    if (!view) return view.error();
    if (look > 0 && !closer(view->region, result.region.magnified_for_px())) break;
    auto seen = look_at(frame, *view, view->blocks, network, pool);
    if (!seen) return seen.error();
    result = {view->region, *std::move(seen), network.links()};
    const float share = seen_width(result.channels);
    if (share >= kNarrow) break;
    width_px *= share;
  }
  if (!near_parts) return result;
  const auto nearer = look_at_near_parts(frame, box, network, result, pool);
  if (!nearer) return nearer.error();
  return result;
}

}  // namespace flowdlo::field
