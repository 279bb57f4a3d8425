#include "evidence/ground_depth.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "evidence/beside_rope.hpp"
#include "evidence/inverse_plane.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/mask_box.hpp"

namespace flowdlo::evidence {
namespace {

using Eigen::Vector2f;

constexpr std::size_t kMostPlaces = 1024;  // beside the mask; more make no better plane
constexpr int kEdgeReachPx = 2;            // around a pixel of the edge, which tells where is out
constexpr std::uint8_t kMaskThreshold = 127;
constexpr double kSurface = 0.9;  // radii over the ground; chosen on 46 training scenes, whose
                                  // nodes came out 1.2 mm too deep at 0 and too near at 1.87

class Mask {
 public:
  explicit Mask(const Frame& frame) : frame_(frame) {}

  /// False beyond the image.
  [[nodiscard]] bool bare(int u, int v) const {
    if (u < 0 || v < 0 || u >= frame_.width || v >= frame_.height) return false;
    return frame_.mask[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame_.width) +
                       static_cast<std::size_t>(u)] <= kMaskThreshold;
  }

  [[nodiscard]] bool at_edge(int u, int v) const {
    return bare(u - 1, v) || bare(u + 1, v) || bare(u, v - 1) || bare(u, v + 1);
  }

  /// Unit, from the mask to what is beside it; 0 where that lies all around.
  [[nodiscard]] Vector2f outward(int u, int v) const {
    Vector2f sum(0, 0);
    for (int dv = -kEdgeReachPx; dv <= kEdgeReachPx; ++dv) {
      for (int du = -kEdgeReachPx; du <= kEdgeReachPx; ++du) {
        if (bare(u + du, v + dv)) sum += Vector2f(static_cast<float>(du), static_cast<float>(dv));
      }
    }
    return sum.norm() > 0 ? sum.normalized() : Vector2f(0, 0);
  }

 private:
  const Frame& frame_;
};

struct Pixels {
  std::size_t all = 0;
  std::size_t measured = 0;
};

Pixels count(const Frame& frame) {
  Pixels pixels;
  geometry::each_masked(frame, [&](int, int, std::size_t index) {
    ++pixels.all;
    pixels.measured += geometry::measured(frame.depth_m[index]) ? 1U : 0U;
  });
  return pixels;
}

Eigen::Vector3d ray_at(const Vector2f& px, const Intrinsics& camera) {
  return geometry::to_eigen(geometry::unproject(camera, px.x(), px.y(), 1)).cast<double>();
}

std::vector<Eigen::Vector2i> edge_of(const Mask& mask, const Frame& frame) {
  std::vector<Eigen::Vector2i> edge;
  geometry::each_masked(frame, [&](int u, int v, std::size_t) {
    if (mask.at_edge(u, v)) edge.emplace_back(u, v);
  });
  return edge;
}

/// What is beside the mask's edge, at evenly many of its pixels.
std::vector<InverseDepth> beside_mask(const Mask& mask, const std::vector<Eigen::Vector2i>& edge,
                                      const Frame& frame) {
  const BesideRope at = BesideRope::of_width(frame.width);
  const std::size_t places = std::min(kMostPlaces, edge.size());
  std::vector<InverseDepth> depths;
  for (std::size_t i = 0; i < places; ++i) {
    const Eigen::Vector2i& place = edge[i * edge.size() / places];
    const Vector2f outward = mask.outward(place.x(), place.y());
    const Vector2f edge_px = place.cast<float>();
    const float depth_m = depth_beside(edge_px, outward, at, frame);
    if (depth_m <= 0) continue;
    depths.push_back({ray_at(edge_px + at.middle_px() * outward, frame.intrinsics),
                      1 / static_cast<double>(depth_m)});
  }
  return depths;
}

}  // namespace

std::optional<std::vector<float>> ground_depth(const Frame& frame) {
  const Pixels pixels = count(frame);
  if (static_cast<float>(pixels.measured) >= kLeastMeasured * static_cast<float>(pixels.all)) {
    return std::nullopt;
  }
  const Mask mask(frame);
  const auto edge = edge_of(mask, frame);
  const auto plane = inverse_plane(beside_mask(mask, edge, frame));
  if (!plane) return std::nullopt;
  // Both edges of a rope are about as long as it, so that this is half of its width.
  const double radius_px = static_cast<double>(pixels.all) / static_cast<double>(edge.size());
  const double radius_m_at_1_m = radius_px / static_cast<double>(frame.intrinsics.fx);
  std::vector<float> depth_m(frame.depth_m.begin(), frame.depth_m.end());
  geometry::each_masked(frame, [&](int u, int v, std::size_t index) {
    if (geometry::measured(depth_m[index])) return;
    const Vector2f px(static_cast<float>(u), static_cast<float>(v));
    const double inverse = plane->normal.dot(ray_at(px, frame.intrinsics));
    const double ground_m = inverse > 0 ? 1 / inverse : 0;
    const double raised_m = kSurface * radius_m_at_1_m * ground_m;
    const auto surface_m = static_cast<float>(ground_m * (1 - raised_m * plane->normal.norm()));
    depth_m[index] = geometry::measured(surface_m) ? surface_m : 0;
  });
  return depth_m;
}

}  // namespace flowdlo::evidence
