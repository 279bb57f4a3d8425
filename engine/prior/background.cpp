#include "prior/background.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace flowdlo::prior {
namespace {

constexpr float kBlockWidths = 0.5F;  // length over which the nearest fifth is taken, and once
                                      // more to both sides
constexpr float kBehindWidths = 4.0F;
constexpr std::size_t kLeastReadings = 5;

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

}  // namespace flowdlo::prior
