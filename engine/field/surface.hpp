// Surface: a strand field between its pixels.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "field/channel.hpp"
#include "geometry/pixel.hpp"

namespace flowdlo::field {

/// The pixel that a place lies in.
[[nodiscard]] inline image::Point pixel_of(const Eigen::Vector2f& p) {
  return {geometry::nearest_px(p.x()), geometry::nearest_px(p.y())};
}

/// A view of `field`, which has to outlive it. Bilinear; 0 beyond it.
class Surface {
 public:
  explicit Surface(const Channels& field) : field_(field) {}

  [[nodiscard]] float at(const Eigen::Vector2f& p, Channel channel) const;

  /// The unit direction of the strand that shows, of both the one nearer to `heading`; none where
  /// there is none.
  [[nodiscard]] std::optional<Eigen::Vector2f> direction(const Eigen::Vector2f& p,
                                                         const Eigen::Vector2f& heading) const;

 private:
  [[nodiscard]] float pixel(int u, int v, Channel channel) const {
    const auto* const found = field_.find(v, u);
    return found != nullptr ? (*found)[channel] : 0.0F;
  }

  const Channels& field_;
};

}  // namespace flowdlo::field
