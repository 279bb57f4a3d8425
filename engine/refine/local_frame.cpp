#include "refine/local_frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "geometry/camera.hpp"

namespace flowdlo::refine {
namespace {

constexpr float kLeastSine = 0.02F;  // of the angle between rope and ray
constexpr float kLeastChord_m = 1e-9F;

}  // namespace

std::array<std::optional<LocalFrame>, kNodes> local_frames(const Centerline& nodes) {
  std::array<std::optional<LocalFrame>, kNodes> frames;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Eigen::Vector3f node = geometry::to_eigen(nodes[i]);
    const Eigen::Vector3f chord =
        geometry::to_eigen(nodes[std::min<std::size_t>(i + 1, kNodes - 1)]) -
        geometry::to_eigen(nodes[i > 0 ? i - 1 : 0]);
    if (!(chord.norm() > kLeastChord_m) || !(node.norm() > kLeastChord_m)) continue;
    LocalFrame frame;
    frame.along = chord.normalized();
    const Eigen::Vector3f aside = node.normalized().cross(frame.along);
    if (!(aside.norm() > kLeastSine)) continue;
    frame.aside = aside.normalized();
    frame.deep = frame.along.cross(frame.aside);
    frames[i] = frame;
  }
  return frames;
}

}  // namespace flowdlo::refine
