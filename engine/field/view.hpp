// FieldView: a strand field as it is asked from the pixels of a frame.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "field/channel.hpp"
#include "field/strand_field.hpp"

namespace flowdlo::field {

/// Shares the field's channels. Places are pixels of the frame, directions unit vectors.
class FieldView {
 public:
  /// Shows nothing anywhere.
  FieldView() = default;
  explicit FieldView(const StrandField& seen);

  /// The same as it is asked from a copy of the frame with `scale` pixels for each of the frame's,
  /// in which the frame's (0, 0) lies at `origin`.
  [[nodiscard]] FieldView from_copy(const Eigen::Vector2f& origin, float scale) const;

  /// [0, 1] how clearly a strand runs somewhere along something.
  struct Shown {
    float top = 0;    ///< one that lies on top
    float below = 0;  ///< one that lies below another

    [[nodiscard]] float any() const { return std::max(top, below); }
  };
  /// By `p` along `along`.
  [[nodiscard]] Shown shown(const Eigen::Vector2f& p, const Eigen::Vector2f& along) const;

  /// What the field says at `p`; 0 beside what it was asked about.
  [[nodiscard]] float at(const Eigen::Vector2f& p, Channel channel) const;

  /// Width of the strand that shows at `p`, pixels of the frame; 0 where none does.
  [[nodiscard]] float width_px(const Eigen::Vector2f& p) const;

  /// Whether the field takes `p` for rope.
  [[nodiscard]] bool is_rope(const Eigen::Vector2f& p) const;

  /// [height, width] of the frame: 255 where it `is_rope`, 0 elsewhere.
  [[nodiscard]] std::vector<std::uint8_t> rope_mask(int width, int height) const;

  /// [0, 1] how clearly the rope's own end shows within a width ahead of `p`, towards `outward`.
  [[nodiscard]] float tip_ahead(const Eigen::Vector2f& p, const Eigen::Vector2f& outward) const;

 private:
  [[nodiscard]] Eigen::Vector2f to_region(const Eigen::Vector2f& p) const {
    return scale_.cwiseProduct(p) + origin_;
  }

  Channels channels_;                   // of the region; or empty
  Eigen::Vector2f scale_{1.0F, 1.0F};   // pixels of the region a pixel of the frame
  Eigen::Vector2f origin_{0.0F, 0.0F};  // where the frame's (0, 0) is in the region
};

}  // namespace flowdlo::field
