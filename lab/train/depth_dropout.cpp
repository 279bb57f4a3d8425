#include "train/depth_dropout.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/camera.hpp"
#include "random/philox.hpp"

namespace flowdlo::train {
namespace {

constexpr std::uint64_t kStream = 0xD209;
constexpr int kMostStretches = 3;
constexpr int kLeastNodes = 3;
constexpr int kMostNodes = 13;        // two of ten together
constexpr float kReachShare = 0.75F;  // of the spacing of nodes: discs overlap along the rope
constexpr float kLeastReach_px = 6;
constexpr float kMoreReach_px = 18;

/// Depth within `reach_px` of (u, v) becomes 0 where there is rope.
void erase_disc(const Frame& frame, float u, float v, float reach_px, std::vector<float>& depth) {
  const int top = std::max(0, static_cast<int>(v - reach_px));
  const int bottom = std::min(frame.height - 1, static_cast<int>(v + reach_px));
  const int left = std::max(0, static_cast<int>(u - reach_px));
  const int right = std::min(frame.width - 1, static_cast<int>(u + reach_px));
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      const float du = static_cast<float>(column) - u;
      const float dv = static_cast<float>(row) - v;
      if (du * du + dv * dv > reach_px * reach_px) continue;
      const auto pixel = static_cast<std::size_t>(row) * frame.width + column;
      if (frame.mask[pixel] > 127) depth[pixel] = 0;
    }
  }
}

}  // namespace

std::vector<float> with_depth_dropout(const Frame& frame, const Centerline& truth,
                                      std::uint64_t seed) {
  std::vector<float> depth(frame.depth_m.begin(), frame.depth_m.end());
  const auto words = random::philox(seed, 0, kStream);
  const int stretches = 1 + static_cast<int>(words[0] % kMostStretches);
  for (int s = 0; s < stretches; ++s) {
    const auto choice = random::philox(seed, static_cast<std::uint64_t>(s) + 1, kStream);
    const int nodes = kLeastNodes + static_cast<int>(choice[0] % (kMostNodes - kLeastNodes + 1));
    const int first = static_cast<int>(choice[1] % static_cast<std::uint32_t>(kNodes - nodes));
    const float least_px =
        kLeastReach_px + kMoreReach_px * static_cast<float>(random::uniform(choice[2]));
    for (int i = first; i < first + nodes; ++i) {
      const Point3& node = truth[static_cast<std::size_t>(i)];
      const Point3& next = truth[static_cast<std::size_t>(i) + 1];
      if (!(node.z > 0 && next.z > 0)) continue;
      const auto at = geometry::project(frame.intrinsics, node);
      const auto spacing_px = (geometry::project(frame.intrinsics, next) - at).norm();
      const float reach_px = std::max(least_px, kReachShare * spacing_px);
      if (!std::isfinite(reach_px) || !at.allFinite()) continue;
      erase_disc(frame, at.x(), at.y(), std::min(reach_px, 100.0F), depth);
    }
  }
  return depth;
}

}  // namespace flowdlo::train
