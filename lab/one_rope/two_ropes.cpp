#include "one_rope/two_ropes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "scene/random.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Rotation2Df;
using Eigen::Vector2f;

constexpr std::array<std::string_view, kArrangements> kNames{"crossing", "apart", "touching",
                                                             "joined"};
constexpr int kTries = 30;
constexpr float kLeastInView = 0.5F;  // of the second rope's mask
constexpr std::uint8_t kMaskThreshold = 127;

Vector2f pixel_of(const FrameFolder& frame, std::size_t node) {
  const Point3& p = (*frame.truth)[node];
  return {frame.intrinsics.fx * p.x / p.z + frame.intrinsics.cx,
          frame.intrinsics.fy * p.y / p.z + frame.intrinsics.cy};
}

Vector2f direction_at(const FrameFolder& frame, std::size_t node) {
  const std::size_t from = node > 1 ? node - 2 : 0;
  const std::size_t to = std::min<std::size_t>(node + 2, kNodes - 1);
  return (pixel_of(frame, to) - pixel_of(frame, from)).normalized();
}

/// Where the pixels of a new frame lie in an old one.
struct Placement {
  Vector2f here{0, 0};   ///< in the new frame
  Vector2f there{0, 0};  ///< the same point in the old one
  float turn_rad = 0;
  float nearer_m = 0;  ///< added to the old depth after scaling

  [[nodiscard]] Vector2f old_px(const Vector2f& px) const {
    return there + Rotation2Df(-turn_rad) * (px - here) / kTwoRopesScale;
  }
  [[nodiscard]] Vector2f new_px(const Vector2f& px) const {
    return here + kTwoRopesScale * (Rotation2Df(turn_rad) * (px - there));
  }
};

/// Index of the nearest pixel; nothing outside.
std::optional<std::size_t> index_of(const FrameFolder& frame, const Vector2f& px) {
  const auto u = std::lround(px.x());
  const auto v = std::lround(px.y());
  if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) return std::nullopt;
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
         static_cast<std::size_t>(u);
}

/// `frame` as it looks from further away; beyond its border its border goes on.
FrameFolder smaller(const FrameFolder& frame, const Placement& placement) {
  FrameFolder result = frame;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const Vector2f old = placement.old_px(Vector2f(static_cast<float>(u), static_cast<float>(v)));
      const Vector2f clamped = old.cwiseMax(0.0F).cwiseMin(
          Vector2f(static_cast<float>(frame.width - 1), static_cast<float>(frame.height - 1)));
      const std::size_t to =
          *index_of(frame, Vector2f(static_cast<float>(u), static_cast<float>(v)));
      const std::size_t from = *index_of(frame, clamped);
      result.depth_m[to] = frame.depth_m[from] / kTwoRopesScale;
      result.mask[to] = index_of(frame, old) ? frame.mask[from] : 0;
      for (std::size_t c = 0; c < 3 && !frame.color_bgr.empty(); ++c) {
        result.color_bgr[3 * to + c] = frame.color_bgr[3 * from + c];
      }
    }
  }
  for (Point3& node : *result.truth) {
    const float z = node.z / kTwoRopesScale;
    const Vector2f px =
        placement.new_px({frame.intrinsics.fx * node.x / node.z + frame.intrinsics.cx,
                          frame.intrinsics.fy * node.y / node.z + frame.intrinsics.cy});
    node = {(px.x() - frame.intrinsics.cx) * z / frame.intrinsics.fx,
            (px.y() - frame.intrinsics.cy) * z / frame.intrinsics.fy, z};
  }
  return result;
}

Placement place(const FrameFolder& first, const FrameFolder& second, Arrangement arrangement,
                Random& random) {
  const auto inner = [&] { return static_cast<std::size_t>(random.integer(16, 47)); };
  std::size_t here = inner();
  std::size_t there = inner();
  float turn_rad = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
  if (arrangement == Arrangement::kTouching || arrangement == Arrangement::kJoined) there = 0;
  if (arrangement == Arrangement::kJoined) here = kNodes - 1;
  const Vector2f along_first = direction_at(first, here);
  const Vector2f along_second = direction_at(second, there);
  const float aligned =
      std::atan2(along_first.y(), along_first.x()) - std::atan2(along_second.y(), along_second.x());
  if (arrangement == Arrangement::kJoined) turn_rad = aligned;
  if (arrangement == Arrangement::kCrossing || arrangement == Arrangement::kTouching) {
    const double side = random.chance(0.5) ? 1 : -1;
    turn_rad = aligned + static_cast<float>(side * random.uniform(0.25, 0.5) * std::numbers::pi);
  }
  Placement placement{pixel_of(first, here), pixel_of(second, there), turn_rad, 0};
  if (arrangement == Arrangement::kApart) {
    placement.here = {static_cast<float>(random.uniform(0.2, 0.8) * first.width),
                      static_cast<float>(random.uniform(0.2, 0.8) * first.height)};
  }
  placement.nearer_m = (*first.truth)[here].z - (*second.truth)[there].z / kTwoRopesScale;
  return placement;
}

/// Whether any rope is within `reach_px` of a pixel.
bool rope_near(const FrameFolder& frame, const Vector2f& px, int reach_px) {
  for (int dv = -reach_px; dv <= reach_px; dv += std::max(1, reach_px / 2)) {
    for (int du = -reach_px; du <= reach_px; du += std::max(1, reach_px / 2)) {
      const auto at =
          index_of(frame, px + Vector2f(static_cast<float>(du), static_cast<float>(dv)));
      if (at && frame.mask[*at] > kMaskThreshold) return true;
    }
  }
  return false;
}

/// About the rope's width where it is one strand.
int width_px(const FrameFolder& frame) {
  const auto lit = std::count_if(frame.mask.begin(), frame.mask.end(),
                                 [](std::uint8_t value) { return value > kMaskThreshold; });
  float length_px = 0;
  for (std::size_t i = 0; i + 1 < kNodes; ++i) {
    length_px += (pixel_of(frame, i + 1) - pixel_of(frame, i)).norm();
  }
  return std::max(1, static_cast<int>(static_cast<float>(lit) / std::max(1.0F, length_px)));
}

/// False where less than `kLeastInView` of it is in view, or where it comes too near.
bool push_over(const FrameFolder& second, const Placement& placement, bool apart,
               FrameFolder& frame) {
  const FrameFolder first = frame;
  const int reach_px = apart ? 2 * width_px(first) + 2 : 0;
  std::size_t shown = 0;
  const auto of_second =
      static_cast<float>(std::count_if(second.mask.begin(), second.mask.end(),
                                       [](std::uint8_t value) { return value > kMaskThreshold; }));
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const Vector2f px(static_cast<float>(u), static_cast<float>(v));
      const auto from = index_of(second, placement.old_px(px));
      if (!from || second.mask[*from] <= kMaskThreshold) continue;
      ++shown;
      if (apart && rope_near(first, px, reach_px)) return false;
      const std::size_t to = *index_of(frame, px);
      const float old_m = second.depth_m[*from];
      const float depth_m = old_m > 0 ? old_m / kTwoRopesScale + placement.nearer_m : 0;
      const bool taken = first.mask[to] > kMaskThreshold;
      if (taken && (depth_m <= 0 || first.depth_m[to] <= depth_m)) continue;
      frame.mask[to] = 255;
      frame.depth_m[to] = depth_m;
      for (std::size_t c = 0; c < 3 && !frame.color_bgr.empty() && !second.color_bgr.empty(); ++c) {
        frame.color_bgr[3 * to + c] = second.color_bgr[3 * *from + c];
      }
    }
  }
  return static_cast<float>(shown) >= kLeastInView * kTwoRopesScale * kTwoRopesScale * of_second;
}

}  // namespace

std::string_view name_of(Arrangement arrangement) {
  return kNames[static_cast<std::size_t>(arrangement)];
}

std::optional<FrameFolder> two_ropes(const FrameFolder& first, const FrameFolder& second,
                                     Arrangement arrangement, std::uint64_t seed) {
  Random random(seed * kArrangements + static_cast<std::uint64_t>(arrangement));
  const Vector2f middle(0.5F * static_cast<float>(first.width),
                        0.5F * static_cast<float>(first.height));
  for (int tries = 0; tries < kTries; ++tries) {
    // The first goes to a corner, so that there is room for the second.
    const Vector2f corner =
        middle + Vector2f(static_cast<float>(random.uniform(-0.15, 0.15) * first.width),
                          static_cast<float>(random.uniform(-0.15, 0.15) * first.height));
    FrameFolder frame = smaller(first, {corner, middle, 0, 0});
    const Placement placement = place(frame, second, arrangement, random);
    if (push_over(second, placement, arrangement == Arrangement::kApart, frame)) return frame;
  }
  return std::nullopt;
}

}  // namespace flowdlo::lab
