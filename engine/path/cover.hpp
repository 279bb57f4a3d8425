// Cover: what the depths beside the mask say of a place where no rope shows: is it hidden by
// something nearer, or would the rope be seen there?
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "field/view.hpp"
#include "flowdlo/frame.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

enum class Sight : std::uint8_t {
  kUnknown,  ///< no depth, or one that tells nothing
  kOpen,     ///< something well behind the rope shows: it is not there
  kHidden,   ///< something well before the rope: it may run behind
};

/// Borrows both arguments. Places are in crop coordinates.
class Cover {
 public:
  /// `seen`, where a strand field was asked, lives on.
  Cover(const Region& region, const Frame& frame, float width_px,
        const field::FieldView* seen = nullptr);

  /// Of the frame's camera.
  [[nodiscard]] float focal_px() const { return frame_.intrinsics.fx; }

  /// Whether there is a field to ask.
  [[nodiscard]] bool has_field() const { return seen_ != nullptr; }

  /// As field::FieldView::shown; nothing without a field.
  [[nodiscard]] field::FieldView::Shown shown(const Eigen::Vector2f& p,
                                              const Eigen::Vector2f& along) const;

  /// What shows at `p`, where the rope's surface would be `rope_m` deep; 0: depth unknown.
  [[nodiscard]] Sight at(const Eigen::Vector2f& p, float rope_m) const;

  /// Whether a rope `rope_m` deep at `p` would be seen there: what shows lies behind it, be it
  /// another strand of the mask.
  [[nodiscard]] bool open(const Eigen::Vector2f& p, float rope_m) const;

  /// What shows behind the mask's edge, walking from `p` along the unit vector `direction` over at
  /// most `reach_px` of mask.
  [[nodiscard]] Sight beyond(Eigen::Vector2f p, const Eigen::Vector2f& direction, float rope_m,
                             float reach_px) const;

  /// Whether the mask goes on from `p` for more than `reach_px`, or begins again within 6 px of its
  /// edge: a strand that passes there.
  [[nodiscard]] bool meets(Eigen::Vector2f p, const Eigen::Vector2f& direction,
                           float reach_px) const;

  /// Depth of the mask around `p`, 0 without any.
  [[nodiscard]] float rope_depth(const Eigen::Vector2f& p) const;

  /// Whether `p` lies on the mask.
  [[nodiscard]] bool masked(const Eigen::Vector2f& p) const;

  /// Whether a pixel of the mask lies there or right beside it: borders of masks are no surer.
  [[nodiscard]] bool near_mask(const Eigen::Vector2f& p) const;

 private:
  // Median depth of the pixels around `p` that are on the mask, or that are not.
  [[nodiscard]] float depth_around(const Eigen::Vector2f& p, bool on_mask) const;
  // Whether a label says that another rope is there.
  [[nodiscard]] bool other_rope(const Eigen::Vector2f& p) const;
  // How much nearer or farther than the rope something must be to tell.
  [[nodiscard]] float margin_m(float rope_m) const;
  [[nodiscard]] bool rises_to(const Eigen::Vector2f& edge, const Eigen::Vector2f& direction,
                              float rope_m) const;

  const Region& region_;
  const Frame& frame_;
  float width_px_;
  const field::FieldView* seen_;
};

}  // namespace flowdlo::path
