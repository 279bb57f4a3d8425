// mask_from_seeds: regions that grow from pixels that somebody clicked on.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"
#include "guard/guarded.hpp"
#include "mask/checks.hpp"
#include "mask/cleaning.hpp"
#include "mask/perceptual.hpp"
#include "mask/regions.hpp"

namespace flowdlo {
namespace mask {
namespace {

constexpr float kMostTolerance = 2;
constexpr float kMostStep_m = 10;

/// How often the regions of all colours together may cover the image: it bounds the time. A rope
/// that fills a tenth of it may have seeds of forty colours.
constexpr std::size_t kMostTimesOver = 4;

bool is_inside(const Pixel& seed, const Frame& frame) {
  return seed.u >= 0 && seed.v >= 0 && seed.u <= static_cast<float>(frame.width - 1) &&
         seed.v <= static_cast<float>(frame.height - 1);
}

Result<void> check(const Frame& frame, std::span<const Pixel> seeds, const SeedGrowth& growth) {
  Checks checks("mask_from_seeds");
  checks.size(frame.width, frame.height);
  checks.color(frame);
  if (!frame.depth_m.empty()) checks.depth(frame);
  checks.positive("SeedGrowth.tolerance", growth.tolerance, kMostTolerance);
  checks.positive("SeedGrowth.lightness_tolerance", growth.lightness_tolerance, kMostTolerance);
  checks.positive("SeedGrowth.depth_step_m", growth.depth_step_m, kMostStep_m);
  checks.cleaning(growth.cleaning);
  if (seeds.empty() || seeds.size() > kMostSeeds) {
    checks.fault(
        fmt::format("expected 1 to {} seeds, got {}; click on the rope", kMostSeeds, seeds.size()));
  }
  for (const Pixel& seed : seeds.first(std::min<std::size_t>(seeds.size(), kMostSeeds))) {
    if (is_inside(seed, frame)) continue;
    checks.fault(fmt::format("expected seeds within {} x {} px, got ({}, {}); click on the rope",
                             frame.width, frame.height, seed.u, seed.v));
  }
  return checks.outcome();
}

std::uint32_t pixel_of(const Pixel& seed, const Size& size) {
  return static_cast<std::uint32_t>(geometry::nearest_px(seed.v) * size.width +
                                    geometry::nearest_px(seed.u));
}

/// Blue, green, red.
using Color = std::array<std::uint8_t, 3>;

/// The median of each channel over the seed's pixel and its neighbours.
Color color_at(std::size_t pixel, const Frame& frame, const Size& size) {
  Color middle{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<std::uint8_t> values{frame.color_bgr[3 * pixel + channel]};
    for_each_neighbour(pixel, size, /*diagonals=*/true, [&](std::size_t other) {
      values.push_back(frame.color_bgr[3 * other + channel]);
    });
    middle[channel] = geometry::median_of(values);
  }
  return middle;
}

/// Pixels of the seeds of each colour, whose regions grow as one.
std::map<Color, Places> starts_of(std::span<const Pixel> seeds, const Frame& frame,
                                  const Size& size) {
  std::map<Color, Places> starts;
  for (const Pixel& seed : seeds) {
    const std::uint32_t pixel = pixel_of(seed, size);
    auto& same = starts[color_at(pixel, frame, size)];
    if (std::find(same.begin(), same.end(), pixel) == same.end()) same.push_back(pixel);
  }
  return starts;
}

Error too_much() {
  return {ErrorCode::kBadInput,
          fmt::format("mask_from_seeds: expected seeds whose regions cover the image at most {} "
                      "times, got more; click on the rope alone, click less often, or lower the "
                      "tolerances",
                      kMostTimesOver)};
}

Result<Mask> by_seeds(const Frame& frame, std::span<const Pixel> seeds, const SeedGrowth& growth) {
  if (auto fine = check(frame, seeds, growth); !fine) return fine.error();
  const Size size{frame.width, frame.height};
  const auto colors = perceived(frame.color_bgr);
  const float apart = growth.tolerance * growth.tolerance;
  const auto stepless = [&](std::size_t from, std::size_t to) {
    if (frame.depth_m.empty()) return true;
    const float here = frame.depth_m[from];
    const float there = frame.depth_m[to];
    return !geometry::measured(here) || !geometry::measured(there) ||
           std::abs(here - there) <= growth.depth_step_m;
  };
  Mask mask(size.pixels());
  Mask reached(size.pixels());
  std::size_t gone_over = 0;
  for (const auto& [color, starts] : starts_of(seeds, frame, size)) {
    const Perceived rope = perceived(color[2], color[1], color[0]);
    for (const std::size_t start : starts) reached[start] = 255;
    const Places region = flood(reached, starts, size, [&](std::size_t from, std::size_t to) {
      return chromatic_distance2(colors[to], rope) <= apart &&
             std::abs(colors[to].lightness - rope.lightness) <= growth.lightness_tolerance &&
             stepless(from, to);
    });
    gone_over += region.size();
    if (gone_over > kMostTimesOver * size.pixels()) return too_much();
    for (const std::size_t pixel : region) {
      mask[pixel] = 255;
      reached[pixel] = 0;
    }
  }
  return cleaned(std::move(mask), size, growth.cleaning);
}

}  // namespace
}  // namespace mask

Result<Mask> mask_from_seeds(const Frame& frame, std::span<const Pixel> seeds,
                             const SeedGrowth& growth) {
  return guard::guarded("mask_from_seeds", [&] { return mask::by_seeds(frame, seeds, growth); });
}

}  // namespace flowdlo
