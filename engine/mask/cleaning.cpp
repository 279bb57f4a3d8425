#include "mask/cleaning.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include "guard/guarded.hpp"
#include "mask/checks.hpp"

namespace flowdlo {
namespace mask {
namespace {

constexpr int kSurrounded = 6;  ///< neighbours of the rope that make a pixel one of it
constexpr int kLone = 2;        ///< fewer neighbours leave it to be noise

Mask smoothed(const Mask& mask, const Size& size) {
  Mask out = mask;
  for (std::size_t pixel = 0; pixel < mask.size(); ++pixel) {
    int neighbours = 0;
    for_each_neighbour(pixel, size, /*diagonals=*/true,
                       [&](std::size_t other) { neighbours += mask[other] != 0 ? 1 : 0; });
    if (neighbours >= kSurrounded) out[pixel] = 255;
    if (neighbours < kLone) out[pixel] = 0;
  }
  return out;
}

/// Regions of `from` that are smaller than `area` become `to`. Of the background, pixels hang
/// together only side by side, so that a line one pixel wide divides it; one that touches the
/// image's border is no hole.
void recolour_small(Mask& mask, const Size& size, std::uint8_t from, std::uint8_t to, float area) {
  const bool holes = from == 0;
  const auto on_border = [&](std::size_t pixel) {
    const auto width = static_cast<std::size_t>(size.width);
    const auto u = pixel % width;
    const auto v = pixel / width;
    return u == 0 || v == 0 || u + 1 == width || v + 1 == static_cast<std::size_t>(size.height);
  };
  std::vector<char> seen(mask.size());
  Places region;
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (seen[start] != 0 || mask[start] != from) continue;
    region.assign(1, static_cast<std::uint32_t>(start));
    seen[start] = 1;
    bool open = false;
    for (std::size_t next = 0; next < region.size(); ++next) {
      open = open || (holes && on_border(region[next]));
      for_each_neighbour(region[next], size, !holes, [&](std::size_t other) {
        if (seen[other] != 0 || mask[other] != from) return;
        seen[other] = 1;
        region.push_back(static_cast<std::uint32_t>(other));
      });
    }
    const auto pixels = static_cast<float>(region.size());
    if (open || (holes ? pixels > area : pixels >= area)) continue;
    for (const std::size_t pixel : region) mask[pixel] = to;
  }
}

Result<Mask> cleaned_of(int width, int height, std::span<const std::uint8_t> given,
                        const MaskCleaning& cleaning) {
  Checks checks("clean_mask");
  checks.size(width, height);
  checks.cleaning(cleaning);
  if (auto fine = checks.outcome(); !fine) return fine.error();
  const Size size{width, height};
  if (given.size() != size.pixels()) {
    checks.fault("mask: expected " + std::to_string(size.pixels()) + " values, got " +
                 std::to_string(given.size()) + "; pass one image");
    return checks.outcome().error();
  }
  Mask mask(given.begin(), given.end());
  for (auto& value : mask) value = value > 127 ? 255 : 0;
  return cleaned(std::move(mask), size, cleaning);
}

}  // namespace

Mask cleaned(Mask mask, const Size& size, const MaskCleaning& cleaning) {
  if (cleaning.smooth) mask = smoothed(mask, size);
  if (cleaning.fill_holes_px2 > 0) {
    recolour_small(mask, size, 0, 255, area_px2(cleaning.fill_holes_px2, size));
  }
  if (cleaning.least_piece_px2 > 0) {
    recolour_small(mask, size, 255, 0, area_px2(cleaning.least_piece_px2, size));
  }
  return mask;
}

}  // namespace mask

Result<Mask> clean_mask(int width, int height, std::span<const std::uint8_t> mask,
                        const MaskCleaning& cleaning) {
  return guard::guarded("clean_mask",
                        [&] { return mask::cleaned_of(width, height, mask, cleaning); });
}

}  // namespace flowdlo
