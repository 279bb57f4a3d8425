// Sec. 3.3: ordered 2D path and path-lifted 3D prior, Eq. (3.1)-(3.7).
#include "prior/prior.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "prior/association.hpp"

namespace flowdlo::prior {
namespace {

// sigma_m is a plausible figure, not a calibrated one.
constexpr double kSigmaFloor_m = 0.001;  // depth noise at half a metre
constexpr float kGapGrowth = 0.5F;       // metres of deviation a metre of rope nobody saw

/// The path resampled to 64 nodes, pixels, in traversal order.
struct ResampledPath {
  std::vector<Eigen::Vector2f> nodes_px;  // [64, 2] q-bar_i
  std::vector<float> arclength_px;        // [64] s_i
};

/// A visible point with its place in the image and along the path.
struct Association {
  Eigen::Vector3d point_cam;
  Eigen::Vector2f position_px;
  float arclength_px;  // s-hat_j
};

ResampledPath resample(const path::Path& path, float length_px) {
  ResampledPath resampled;
  resampled.nodes_px = geometry::resample(path.points_px, kNodes);  // Eq. (3.2)
  for (int i = 0; i < kNodes; ++i) {
    resampled.arclength_px.push_back(static_cast<float>(i) / (kNodes - 1) * length_px);  // (3.2)
  }
  return resampled;
}

/// Points too far from the path to support any node are left out: a node lies on the path, so that
/// the first condition of Eq. (3.3) fails for them.
std::vector<Association> associate_visible(const path::Path& path,
                                           const std::vector<float>& arclength_px,
                                           const evidence::VisiblePoints& visible,
                                           const Intrinsics& camera, const LiftConfig& scaled) {
  std::vector<Sighting> sightings;
  std::vector<Association> associations;
  for (std::size_t j = 0; j < visible.points_cam.size(); ++j) {
    const Point3& point = visible.points_cam[j];
    if (visible.valid[j] == 0 || !(point.z > 0)) continue;
    const Eigen::Vector2f position_px = geometry::project(camera, point);
    sightings.push_back({position_px, point.z});
    associations.push_back({geometry::to_eigen(point).cast<double>(), position_px, 0});
  }
  const std::vector<float> found = associate(path.points_px, arclength_px, sightings,
                                             scaled.lift_radius_px, scaled.arc_window_px);
  for (std::size_t j = 0; j < found.size(); ++j) associations[j].arclength_px = found[j];
  std::erase_if(associations, [](const Association& entry) { return entry.arclength_px < 0; });
  return associations;
}

/// w_ij, or zero when observation j is no candidate of the node.
double weight(const Association& seen, const Eigen::Vector2f& node_px, float arclength_px,
              const LiftConfig& scaled) {
  const float distance_px = (seen.position_px - node_px).norm();
  const float arc_px = std::abs(seen.arclength_px - arclength_px);
  if (distance_px > scaled.lift_radius_px || arc_px > scaled.arc_window_px) return 0;  // Eq. (3.3)
  const double across = static_cast<double>(distance_px / scaled.sigma_px);
  const double along = static_cast<double>(arc_px / scaled.sigma_arc_px);
  return std::exp(-0.5 * across * across) * std::exp(-0.5 * along * along);  // Eq. (3.4)
}

/// Position, support and sigma of node i from its candidates; untouched when there are none.
void lift_node(std::size_t i, const ResampledPath& path, const std::vector<Association>& seen,
               const LiftConfig& scaled, float fx, Prior& prior) {
  double weights = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<double> weight_of(seen.size());
  for (std::size_t j = 0; j < seen.size(); ++j) {
    weight_of[j] = weight(seen[j], path.nodes_px[i], path.arclength_px[i], scaled);
    weights += weight_of[j];
    sum += weight_of[j] * seen[j].point_cam;
  }
  if (weights <= 0) return;
  const Eigen::Vector3d mean = sum / weights;  // Eq. (3.5)
  double spread = 0;
  for (std::size_t j = 0; j < seen.size(); ++j) {
    spread += weight_of[j] * (seen[j].point_cam - mean).squaredNorm();
  }
  const double floor_m = kSigmaFloor_m + mean.z() / static_cast<double>(fx);  // and one pixel
  prior.nodes[i] = geometry::to_point(mean.cast<float>());
  prior.support[i] = 1;  // Eq. (3.6)
  prior.sigma_m[i] = static_cast<float>(std::sqrt(spread / weights + floor_m * floor_m));
}

/// Fills node i from its supported neighbours; `left` and `right` are -1 where there is none. Its
/// sigma grows from the neighbour that then promises the smaller one.
void complete_node(int i, int left, int right, const ResampledPath& path, float fx, Prior& prior) {
  const auto at = [](int index) { return static_cast<std::size_t>(index); };
  Point3& node = prior.nodes[at(i)];
  node = prior.nodes[at(left >= 0 ? left : right)];
  if (left >= 0 && right >= 0) {
    const float alpha = static_cast<float>(i - left) / static_cast<float>(right - left);
    const Eigen::Vector3f from = geometry::to_eigen(prior.nodes[at(left)]);
    const Eigen::Vector3f to = geometry::to_eigen(prior.nodes[at(right)]);
    node = geometry::to_point((1 - alpha) * from + alpha * to);  // Eq. (3.7)
  }
  float& sigma_m = prior.sigma_m[at(i)];
  sigma_m = std::numeric_limits<float>::max();
  for (const int neighbour : {left, right}) {
    if (neighbour < 0) continue;
    const float gap_px = std::abs(path.arclength_px[at(i)] - path.arclength_px[at(neighbour)]);
    const float growth_m = kGapGrowth * gap_px * node.z / fx;
    sigma_m = std::min(sigma_m, std::hypot(prior.sigma_m[at(neighbour)], growth_m));
  }
}

/// Completes the nodes without support, Eq. (3.7). At least one node is supported.
void complete(const ResampledPath& path, float fx, Prior& prior) {
  std::array<int, kNodes> right{};
  int next = -1;
  for (int i = kNodes - 1; i >= 0; --i) {
    if (prior.support[static_cast<std::size_t>(i)] != 0) next = i;
    right[static_cast<std::size_t>(i)] = next;
  }
  int left = -1;
  for (int i = 0; i < kNodes; ++i) {
    if (prior.support[static_cast<std::size_t>(i)] != 0) {
      left = i;
    } else {
      complete_node(i, left, right[static_cast<std::size_t>(i)], path, fx, prior);
    }
  }
}

LiftConfig scaled_to(const LiftConfig& config, int image_width) {
  const float scale = geometry::pixel_scale(image_width);
  return {config.lift_radius_px * scale, config.arc_window_px * scale, config.sigma_px * scale,
          config.sigma_arc_px * scale};
}

bool usable(const path::Path& path) {
  return path.points_px.size() >= 2 &&
         std::all_of(path.points_px.begin(), path.points_px.end(),
                     [](const Eigen::Vector2f& point) { return point.allFinite(); });
}

}  // namespace

bool is_canonical(const Centerline& nodes) {
  const Point3& first = nodes.front();
  const Point3& last = nodes.back();
  return std::tie(first.x, first.y, first.z) <= std::tie(last.x, last.y, last.z);
}

Result<Prior> lift(const path::Path& path, const evidence::VisiblePoints& visible,
                   const Frame& frame, const LiftConfig& config) {
  if (!usable(path)) {
    return Error{ErrorCode::kNoPath,
                 fmt::format("prior::lift: expected a path of at least 2 finite points, got {}; "
                             "check the mask",
                             path.points_px.size())};
  }
  const LiftConfig scaled = scaled_to(config, frame.width);
  const std::vector<float> arclength_px = geometry::cumulative_length(path.points_px);  // Eq. (3.1)
  const ResampledPath resampled = resample(path, arclength_px.back());
  const std::vector<Association> seen =
      associate_visible(path, arclength_px, visible, frame.intrinsics, scaled);

  Prior prior;
  for (std::size_t i = 0; i < kNodes; ++i) {
    lift_node(i, resampled, seen, scaled, frame.intrinsics.fx, prior);
  }
  if (std::all_of(prior.support.begin(), prior.support.end(), [](int h) { return h == 0; })) {
    return Error{
        ErrorCode::kNoEvidence,
        fmt::format("prior::lift: expected visible points within {:.1f} px of the path, got none "
                    "of {}; check that depth and mask belong to the same camera",
                    static_cast<double>(scaled.lift_radius_px), visible.count)};
  }
  complete(resampled, frame.intrinsics.fx, prior);
  if (!is_canonical(prior.nodes)) {  // Sec. 3.3
    std::reverse(prior.nodes.begin(), prior.nodes.end());
    std::reverse(prior.support.begin(), prior.support.end());
    std::reverse(prior.sigma_m.begin(), prior.sigma_m.end());
  }
  return prior;
}

}  // namespace flowdlo::prior
