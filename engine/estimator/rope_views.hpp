// Rope views: a frame of several ropes as one frame for each, in which the others only hide it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/conditions.hpp"
#include "estimator/parted.hpp"
#include "flowdlo/frame.hpp"
#include "path/path.hpp"

namespace flowdlo::estimator {

/// The frame as one of its ropes has it.
class RopeView {
 public:
  /// The mask is the rope's own pixels and those where it runs below another one: these have no
  /// depth. The images of `frame` live on.
  RopeView(const Parted& parted, std::size_t rope, const Frame& frame);

  /// Views into this object and into the images of the frame given.
  [[nodiscard]] Frame frame() const;

  /// The rope's way through it, as it was found among the others, and what the field shows there.
  [[nodiscard]] Traced traced() const;

 private:
  path::Path path_;
  float width_px_;
  bool filtered_;
  std::optional<field::FieldView> seen_;
  Frame original_;
  std::vector<std::uint8_t> mask_;
  std::vector<float> depth_m_;
};

}  // namespace flowdlo::estimator
