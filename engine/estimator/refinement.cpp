#include "estimator/refinement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <variant>

#include "geometry/camera.hpp"
#include "geometry/depth.hpp"

namespace flowdlo::estimator {

namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// A place that is given as an end lies that near to the line on which the rope goes on, widths, and
// that near to the end that was read, along it. What lies elsewhere says nothing of this end.
constexpr float kMostAside = 1.5F;
constexpr float kMostGiven = 6;
constexpr std::size_t kOutNodes = 4;  // from an end, over which the rope's direction there is taken

/// A place beside an end.
struct Beside {
  float beyond_m = 0;  ///< along the rope, from the end on
  float aside_m = 0;   ///< from the line on which it goes on
};

/// Nothing where the end cannot be seen, or the rope runs along the ray there.
std::optional<Beside> beside(const Centerline& nodes, bool last, const Place& place,
                             const Intrinsics& camera) {
  const Vector3f end = geometry::to_eigen(last ? nodes.back() : nodes.front());
  const Vector3f before = geometry::to_eigen(nodes[last ? kNodes - 1 - kOutNodes : kOutNodes]);
  const float length_m = (end - before).norm();
  if (!(length_m > 0) || !(end.z() > geometry::kLeastDepth_m)) return std::nullopt;
  if (const auto* point = std::get_if<Point3>(&place)) {
    const Vector3f off = geometry::to_eigen(*point) - end;
    const float beyond_m = off.dot(end - before) / length_m;
    return Beside{beyond_m, (off - beyond_m / length_m * (end - before)).norm()};
  }
  if (!(before.z() > geometry::kLeastDepth_m)) return std::nullopt;
  const Vector2f end_px = geometry::project(camera, geometry::to_point(end));
  const Vector2f along_px = end_px - geometry::project(camera, geometry::to_point(before));
  const auto& pixel = std::get<Pixel>(place);
  const Vector2f off_px = Vector2f(pixel.u, pixel.v) - end_px;
  if (!(along_px.norm() > 1)) return std::nullopt;
  const float beyond_px = off_px.dot(along_px) / along_px.norm();
  const float pixel_m = end.z() / camera.fx;
  return Beside{beyond_px * length_m / along_px.norm(),
                (off_px - beyond_px / along_px.norm() * along_px).norm() * pixel_m};
}

/// Each place is one end's, the one that it is nearer to.
std::array<std::optional<float>, 2> tips_given(const gate::Candidate& prior, const Hints& hints,
                                               const Intrinsics& camera) {
  std::array<std::optional<float>, 2> tips;
  std::array<float, 2> nearest{};
  const float width_m = 2 * prior.radius_m;
  for (const Place& place : hints.ends) {
    std::array<std::optional<Beside>, 2> of{beside(prior.nodes, false, place, camera),
                                            beside(prior.nodes, true, place, camera)};
    const auto away = [&](std::size_t end) {
      return std::abs(of[end]->beyond_m) + std::abs(of[end]->aside_m);
    };
    for (const std::size_t end : {0U, 1U}) {
      if (!of[end] || !(of[end]->aside_m <= kMostAside * width_m)) continue;
      if (!(std::abs(of[end]->beyond_m) <= kMostGiven * width_m)) continue;
      if (of[1 - end] && away(1 - end) < away(end)) continue;
      if (tips[end] && nearest[end] <= away(end)) continue;
      tips[end] = of[end]->beyond_m;
      nearest[end] = away(end);
    }
  }
  return tips;
}

refine::EndsKnown ends_known(const gate::Candidate& prior, const SecondLook& look,
                             double rope_length_m, const Hints& hints, const Frame& frame) {
  if (prior.ring != 0) return {};
  return {look.seen ? &*look.seen : nullptr, rope_length_m,
          tips_given(prior, hints, frame.intrinsics)};
}

}  // namespace

refine::Curve curve_of(const gate::Candidate& candidate) {
  return {candidate.nodes,    candidate.sigma_m, candidate.unseen_m,
          candidate.radius_m, candidate.pixel_m, candidate.noise_m};
}

Result<refine::Refined> refined(const gate::Candidate& prior, const SecondLook& look,
                                const Frame& frame, refine::Network& network, double rope_length_m,
                                const Hints& hints) {
  return refine::refined(curve_of(prior), frame, network,
                         ends_known(prior, look, rope_length_m, hints, frame));
}

Centerline with_tips(const gate::Candidate& prior, const SecondLook& look, const Frame& frame,
                     const refine::Network& network, double rope_length_m, const Hints& hints) {
  return refine::with_tips(curve_of(prior), prior.nodes, frame, network,
                           ends_known(prior, look, rope_length_m, hints, frame))
      .nodes;
}

}  // namespace flowdlo::estimator
