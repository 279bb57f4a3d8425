#include "field/sight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "field/resampling.hpp"
#include "field/rope_depth.hpp"
#include "geometry/depth.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::field {
namespace {

constexpr float kMost = 3;             // what a plane of the input holds at most
constexpr float kHalf = 0.5F;          // share of a pixel that makes it mask, or measured
constexpr float kLeastSpread = 0.05F;  // of a rope of one colour, 0 to 1
constexpr int kLeastColored = 20;      // rope pixels that tell its colour

/// The rope's colour as the mask shows it, and how much it varies.
struct Palette {
  Color middle{};
  float spread = 1;
};

Palette palette_of(const NearSight& sight) {
  std::vector<Color> seen;
  const auto collect = [&](float least_mask) {
    sight.pixels.for_rows([&](int, int, const SeenPixel* at, int count) {
      for (int i = 0; i < count; ++i) {
        if (at[i][kSeenInside] <= kHalf || at[i][kSeenMask] <= least_mask) continue;
        seen.push_back({at[i][kSeenBlue], at[i][kSeenGreen], at[i][kSeenRed]});
      }
    });
  };
  collect(kHalf);
  if (seen.size() < kLeastColored) {
    seen.clear();
    collect(-1);
  }
  Palette palette;
  if (seen.empty()) return palette;
  double deviation = 0;
  std::vector<float> values(seen.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      values[i] = seen[i][k];
      sum += static_cast<double>(values[i]);
      squares += static_cast<double>(values[i]) * static_cast<double>(values[i]);
    }
    const auto count = static_cast<double>(seen.size());
    deviation += std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)) / 3;
    palette.middle[k] = geometry::median_of(values);
  }
  palette.spread = 2 * static_cast<float>(deviation) + kLeastSpread;
  return palette;
}

using Bgr = std::array<std::uint8_t, 3>;

/// Whether a picture shows anything: one of a single colour, as a camera's stream that never began
/// is, does not.
bool varies(const image::Image<const Bgr>& picture) {
  const auto first = picture.at(0, 0);
  for (int v = 0; v < picture.height(); ++v) {
    const auto* row = picture.row(v);
    if (std::any_of(row, row + picture.width(), [&](const Bgr& at) { return at != first; })) {
      return true;
    }
  }
  return false;
}

/// A part of an image of the frame.
template <class T, class Stored>
image::Image<const T> part_of(std::span<const Stored> pixels, const Frame& frame,
                              const image::Rect& box) {
  const image::Image<const T> whole(reinterpret_cast<const T*>(pixels.data()),
                                    {frame.width, frame.height}, frame.width);
  return whole.part(box);
}

float within(float value) { return std::clamp(value, -kMost, kMost); }

/// A region of a frame as it is resampled.
class Looker {
 public:
  Looker(const Frame& frame, const Region& region)
      : mask_(part_of<std::uint8_t>(frame.mask, frame, region.box)),
        depth_m_(part_of<float>(frame.depth_m, frame, region.box)),
        all_(image::all_of(region.size)),
        resampling_(region.box.size(), region.size) {
    if (frame.color_bgr.empty()) return;
    const auto given = part_of<Bgr>(frame.color_bgr, frame, region.box);
    if (varies(given)) color_ = given;
  }

  [[nodiscard]] bool has_color() const { return !color_.empty(); }

  /// Whether the mask lies below any pixel of a block.
  [[nodiscard]] bool masked(const image::Point& block) const {
    const image::Rect source = resampling_.source_of(pixels_of(block) & all_);
    for (int v = source.y; v < source.y + source.height; ++v) {
      const std::uint8_t* const row = mask_.row(v) + source.x;
      std::uint8_t any = 0;
      for (int u = 0; u < source.width; ++u) any |= row[u];
      if (any > 127) return true;
    }
    return false;
  }

  /// The mask's share of each pixel of a block, [kBlock_px, kBlock_px]; 0 beyond the region.
  [[nodiscard]] const float* mask_of(const image::Point& block) {
    return resampled(
               block, shares_,
               [this](int v, int u) { return std::array{mask_.at(v, u) > 127 ? 1.0F : 0.0F}; })
        ->data();
  }

  /// All that is seen of a block; 0 beyond the region.
  void look(const image::Point& block, SeenPixel* to) {
    const auto* const from =
        resampled(block, pixels_, [this](int v, int u) { return given(v, u); });
    const image::Rect part = pixels_of(block) & all_;
    std::copy_n(from, kBlock_px * kBlock_px, to);
    for (int v = 0; v < part.height; ++v) {
      for (int u = 0; u < part.width; ++u) {
        SeenPixel& at = to[v * kBlock_px + u];
        const float measured = at[kSeenInside];
        at[kSeenDepth] = measured > kHalf ? at[kSeenDepth] / measured : 0.0F;
        at[kSeenInside] = 1;
      }
    }
  }

 private:
  template <class Pixel>
  struct Patches {
    std::vector<Pixel> given;  // that a block is made of
    std::vector<Pixel> rows;
    std::vector<Pixel> block = std::vector<Pixel>(kBlock_px * kBlock_px);
  };

  /// A pixel of the frame; kSeenInside is whether its depth was measured.
  [[nodiscard]] SeenPixel given(int v, int u) const {
    constexpr auto kScale = static_cast<float>(1.0 / 255);
    SeenPixel pixel{};
    if (!color_.empty()) {
      const Bgr& color = color_.at(v, u);
      for (std::size_t k = 0; k < 3; ++k) pixel[kSeenBlue + k] = color[k] * kScale;
    }
    const float depth_m = depth_m_.at(v, u);
    const bool measured = geometry::measured(depth_m);
    pixel[kSeenDepth] = measured ? depth_m : 0.0F;
    pixel[kSeenInside] = measured ? 1.0F : 0.0F;
    pixel[kSeenMask] = mask_.at(v, u) > 127 ? 1.0F : 0.0F;
    return pixel;
  }

  template <class Pixel, class Given>
  const Pixel* resampled(const image::Point& block, Patches<Pixel>& patches, const Given& given) {
    const image::Rect part = pixels_of(block) & all_;
    const image::Rect source = resampling_.source_of(part);
    patches.given.resize(static_cast<std::size_t>(source.area()));
    auto to = patches.given.begin();
    for (int v = source.y; v < source.y + source.height; ++v) {
      for (int u = source.x; u < source.x + source.width; ++u) *to++ = given(v, u);
    }
    if (part.width < kBlock_px || part.height < kBlock_px) {
      std::fill(patches.block.begin(), patches.block.end(), Pixel{});
    }
    resampling_.resample(patches.given.data(), source, part, patches.block.data(), kBlock_px,
                         patches.rows);
    return patches.block.data();
  }

  image::Image<const std::uint8_t> mask_;
  image::Image<const float> depth_m_;
  image::Image<const Bgr> color_;  // empty: none, or one colour everywhere
  image::Rect all_;                // of the region
  Resampling resampling_;
  Patches<std::array<float, 1>> shares_;
  Patches<SeenPixel> pixels_;
};

/// Pieces of work on blocks: some together, for each piece has memory of its own.
constexpr int kTogether = 8;

/// work(first, last) on all blocks up to `count`.
template <class Work>
void over_blocks(std::size_t count, threads::Pool* pool, const Work& work) {
  const auto pieces = static_cast<int>((count + kTogether - 1) / kTogether);
  threads::share_out(pool, pieces, [&](int piece) {
    const auto first = static_cast<std::size_t>(piece) * kTogether;
    work(first, std::min(count, first + kTogether));
  });
}

}  // namespace

BlockMap blocks_near(const Frame& frame, const Region& region, threads::Pool* pool) {
  const BlockMap all = all_blocks(region.size);
  const Looker looker(frame, region);
  std::vector<NearBlock> near(all.blocks.size());
  over_blocks(all.blocks.size(), pool, [&](std::size_t first, std::size_t last) {
    Looker own = looker;
    for (std::size_t i = first; i < last; ++i) {
      if (own.masked(all.blocks[i])) near[i] = near_block(own.mask_of(all.blocks[i]));
    }
  });
  return blocks_near(all, near);
}

NearSight look(const Frame& frame, const Region& region, std::shared_ptr<const BlockMap> blocks,
               threads::Pool* pool) {
  const Looker looker(frame, region);
  NearSight sight{BlockImage<SeenPixel>::over(region.size, std::move(blocks)), looker.has_color(),
                  frame.intrinsics.fx * region.scale.x()};
  const auto& wanted = sight.pixels.map()->blocks;
  over_blocks(wanted.size(), pool, [&](std::size_t first, std::size_t last) {
    Looker own = looker;
    for (std::size_t i = first; i < last; ++i) own.look(wanted[i], sight.pixels.block(i));
  });
  return sight;
}

Sight look(const Frame& frame, const Region& region) {
  const auto all = std::make_shared<const BlockMap>(all_blocks(region.size));
  const NearSight seen = look(frame, region, all);
  Sight sight;
  sight.focal_px = seen.focal_px;
  if (seen.has_color) sight.color = image::Image<Color>(region.size);
  for (auto* plane : {&sight.mask, &sight.depth_m, &sight.inside}) {
    *plane = image::Image<float>(region.size);
  }
  seen.pixels.for_rows([&](int v, int first, const SeenPixel* at, int count) {
    for (int i = 0; i < count; ++i) {
      const int u = first + i;
      if (seen.has_color) {
        sight.color.at(v, u) = {at[i][kSeenBlue], at[i][kSeenGreen], at[i][kSeenRed]};
      }
      sight.mask.at(v, u) = at[i][kSeenMask];
      sight.depth_m.at(v, u) = at[i][kSeenDepth];
      sight.inside.at(v, u) = at[i][kSeenInside];
    }
  });
  return sight;
}

/// What the planes are measured against.
struct Input::Scales {
  Palette palette;
  RopeDepth depth;
};

Input::Input(const NearSight& sight)
    : sight_(sight),
      scales_(std::make_shared<const Scales>(
          Scales{sight.has_color ? palette_of(sight) : Palette{}, RopeDepth(sight)})) {}

void Input::planes_of(std::size_t block, PlanesOfPixel* to) const {
  const Palette& palette = scales_->palette;
  const RopeDepth& around = scales_->depth;
  const SeenPixel* const seen = sight_.pixels.block(block);
  for (int v = 0; v < kBlock_px; ++v) {
    std::array<float, kBlock_px> rope_m{};
    if (!around.empty()) around.row_of(sight_.pixels.map()->blocks[block], v, rope_m.data());
    for (int u = 0; u < kBlock_px; ++u) {
      const SeenPixel& at = seen[v * kBlock_px + u];
      PlanesOfPixel planes{};
      if (at[kSeenInside] > kHalf) {
        for (std::size_t k = 0; k < 3 && sight_.has_color; ++k) {
          planes[kBlue + k] = within((at[kSeenBlue + k] - palette.middle[k]) / palette.spread);
        }
        planes[kHasColor] = sight_.has_color ? 1.0F : 0.0F;
        if (at[kSeenDepth] > 0 && !around.empty()) {
          const float width_m = kRope_px * rope_m[u] / sight_.focal_px;
          planes[kDepth] = within((at[kSeenDepth] - rope_m[u]) / (2 * width_m));
          planes[kHasDepth] = 1;
        }
        planes[kMask] = at[kSeenMask];
      }
      to[v * kBlock_px + u] = planes;
    }
  }
}

Planes input_of(const Sight& sight) {
  const auto all = std::make_shared<const BlockMap>(all_blocks(sight.mask.size()));
  NearSight seen{{sight.mask.size(), all, {}}, !sight.color.empty(), sight.focal_px};
  for (int v = 0; v < sight.mask.height(); ++v) {
    for (int u = 0; u < sight.mask.width(); ++u) {
      SeenPixel& at = seen.pixels.at(v, u);
      for (std::size_t k = 0; k < 3 && seen.has_color; ++k) {
        at[kSeenBlue + k] = sight.color.at(v, u)[k];
      }
      at[kSeenMask] = sight.mask.at(v, u);
      at[kSeenDepth] = sight.depth_m.at(v, u);
      at[kSeenInside] = sight.inside.at(v, u);
    }
  }
  const Input input(seen);
  auto planes = BlockImage<PlanesOfPixel>::over(sight.mask.size(), all);
  for (std::size_t i = 0; i < all->blocks.size(); ++i) input.planes_of(i, planes.block(i));
  return planes.whole();
}

}  // namespace flowdlo::field
