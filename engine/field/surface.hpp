// Surface: a strand field between its pixels.
#pragma once

#include <Eigen/Core>
#include <array>
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

  [[nodiscard]] float at(const Eigen::Vector2f& p, Channel channel) const {
    return spot(p).at(channel);
  }

  /// A place, for whoever asks it for several channels.
  class Spot {
   public:
    [[nodiscard]] float at(Channel channel) const {
      const auto value = [&](int corner) { return (*corners_[corner])[channel]; };
      return (1 - t_) * ((1 - s_) * value(0) + s_ * value(1)) +
             t_ * ((1 - s_) * value(2) + s_ * value(3));
    }

   private:
    friend class Surface;

    std::array<const std::array<float, kChannels>*, 4> corners_{};  // row by row
    float s_ = 0;
    float t_ = 0;
  };
  [[nodiscard]] Spot spot(const Eigen::Vector2f& p) const;

  /// The unit direction of the strand that shows, of both the one nearer to `heading`; none where
  /// there is none.
  [[nodiscard]] static std::optional<Eigen::Vector2f> direction(const Spot& spot,
                                                                const Eigen::Vector2f& heading);

 private:
  const Channels& field_;
};

}  // namespace flowdlo::field
