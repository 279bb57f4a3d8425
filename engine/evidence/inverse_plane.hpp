// InversePlane: the plane through depths of which many may be of something else.
//
// 1 / z of a plane's points is linear along the image, and 1 / z is what a camera that matches
// pictures measures with the same error everywhere.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace flowdlo::evidence {

struct InverseDepth {
  Eigen::Vector3d ray{0, 0, 1};  ///< (x / z, y / z, 1)
  double inverse = 0;            ///< 1 / z, 1 / m
};

struct InversePlane {
  Eigen::Vector3d normal{0, 0, 1};  ///< 1 / z of its points is this times their ray
  double misfit = 0;  ///< typical, of the inverse depths, 1 / m: 1.4826 times the median

  /// 1 / m, above 0 where the plane is nearer than what was measured.
  [[nodiscard]] double off(const InverseDepth& at) const { return normal.dot(at.ray) - at.inverse; }
};

/// The plane of least median misfit through three of the depths, then Tukey's biweight from there:
/// up to half of them may be of something else. The same depths always give the same plane. Nothing
/// where they are fewer than 48, or all lie on a line of the image.
[[nodiscard]] std::optional<InversePlane> inverse_plane(std::span<const InverseDepth> depths);

}  // namespace flowdlo::evidence
