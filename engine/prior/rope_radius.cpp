#include "prior/rope_radius.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

constexpr float kEdgePx = 0.25F;         // how far both edges together lie beyond what was probed
constexpr std::size_t kLeastWidths = 8;  // measured ones, for a radius
constexpr float kTellingPx = 4.0F;       // depths of thinner ropes do not tell their radius
constexpr std::size_t kBins = 20;        // of distance from the axis, over the mask's radius
constexpr std::size_t kLeastInBin = 40;
constexpr float kFallsAway = 1.4F;    // times the distance from the axis
constexpr float kBlockWidths = 0.5F;  // length over which the nearest fifth is taken, and once
                                      // more to both sides
constexpr float kBehindWidths = 4.0F;
constexpr std::size_t kLeastReadings = 5;
constexpr float kLeast_m = 5e-4F;
constexpr float kMost_m = 0.04F;

/// The mean of the middle half: widths are counted in pixels, so that a median would be too.
float midmean_of(std::vector<float>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t first = values.size() / 4;
  const std::size_t last = std::max(first + 1, values.size() - values.size() / 4);
  float sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += values[i];
  return sum / static_cast<float>(last - first);
}

}  // namespace

std::vector<float> background_m(const Strip& strip) {
  const auto count = static_cast<int>(strip.stations.size());
  const int length = std::clamp(
      static_cast<int>(kBlockWidths * strip.width_px / std::max(strip.step_px, 1e-3F)), 1, count);
  std::vector<std::vector<float>> depths(static_cast<std::size_t>((count - 1) / length) + 1);
  for (const Reading& reading : strip.readings) {
    if (reading.rival >= 0) continue;
    depths[static_cast<std::size_t>(reading.station / length)].push_back(reading.depth_m);
  }
  std::vector<float> result(strip.stations.size(), std::numeric_limits<float>::max());
  std::vector<float> around;
  for (std::size_t block = 0; block < depths.size(); ++block) {
    around.clear();
    for (std::size_t b = block > 0 ? block - 1 : 0; b < std::min(block + 2, depths.size()); ++b) {
      around.insert(around.end(), depths[b].begin(), depths[b].end());
    }
    if (around.size() < kLeastReadings) continue;
    const auto fifth = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 5);
    std::nth_element(around.begin(), fifth, around.end());
    const std::size_t last = std::min(strip.stations.size(), (block + 1) * length);
    for (std::size_t i = block * length; i < last; ++i) {
      result[i] = *fifth * (1 + kBehindWidths * strip.width_px * strip.stations[i].aside);
    }
  }
  return result;
}

float mask_radius_m(const Strip& strip, const Extent& extent, std::span<const float> background_m) {
  std::vector<float> depth(strip.stations.size(), 0.0F);  // of the reading nearest to the axis
  std::vector<float> off(strip.stations.size(), strip.width_px);
  std::vector<float> all;
  for (const Reading& reading : strip.readings) {
    const auto i = static_cast<std::size_t>(reading.station);
    all.push_back(reading.depth_m);
    if (std::abs(reading.offset_px) >= off[i] || reading.depth_m > background_m[i]) continue;
    off[i] = std::abs(reading.offset_px);
    depth[i] = reading.depth_m;
  }
  const float typical_m = geometry::median_of(all);
  std::vector<float> radii;
  for (std::size_t i = 0; i < strip.stations.size(); ++i) {
    const Station& at = strip.stations[i];
    if (!at.bounded || strip.neighbour[i] >= 0 || depth[i] <= 0 || !extent.holds(at)) continue;
    const float half = 0.5F * (at.left_px + at.right_px + kEdgePx) * at.aside;  // at 1 m
    radii.push_back(half * depth[i] / std::max(0.5F, 1 - half));  // the axis is r deeper
  }
  const float guess = 0.5F * strip.width_px * strip.stations.front().aside * typical_m;
  return std::clamp(radii.size() < kLeastWidths ? guess : midmean_of(radii), kLeast_m, kMost_m);
}

float depth_radius_m(const Strip& strip, const Extent& extent, std::span<const double> axis_m,
                     std::span<const float> slant, float mask_radius_m) {
  if (strip.width_px < kTellingPx) return mask_radius_m;
  std::array<std::vector<float>, kBins> behind;
  std::vector<float> ridge;
  for (const Reading& reading : strip.readings) {
    const auto i = static_cast<std::size_t>(reading.station);
    const Station& at = strip.stations[i];
    if (reading.rival >= 0 || !extent.holds(at)) continue;
    const auto axis = static_cast<float>(axis_m[i]);
    const float x = std::abs(reading.offset_px) * at.aside * axis / mask_radius_m;
    if (!(x >= 0 && x < 1)) continue;
    const auto bin = static_cast<std::size_t>(x * kBins);
    behind[bin].push_back((reading.depth_m - axis) * at.ray.norm() / slant[i]);
    if (bin < kBins / 4) ridge.push_back(behind[bin].back());
  }
  if (ridge.size() < kLeastInBin) return mask_radius_m;
  const float top = geometry::median_of(ridge);
  for (std::size_t bin = kBins / 2; bin < kBins; ++bin) {
    if (behind[bin].size() < kLeastInBin) continue;
    const float x_m = (static_cast<float>(bin) + 0.5F) / kBins * mask_radius_m;
    if (geometry::median_of(behind[bin]) - top < kFallsAway * x_m) continue;
    return std::max(kLeast_m, static_cast<float>(bin) / kBins * mask_radius_m);
  }
  return mask_radius_m;
}

}  // namespace flowdlo::prior
