// Look: colours of a scene, and its picture in them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "synth/synthetic_frame.hpp"
#include "synth/tracer.hpp"

namespace flowdlo::synth {

struct Material {
  std::string_view name;
  Vector3d color_bgr;
  HsvBand band;  ///< of the rope where it is lit
  bool dark = false;
};

/// One of the thesis' five, Sec. 4.1.1.
[[nodiscard]] const Material& draw_material(Dice& dice);

/// What two sets of strands that wind around a rope make of its surface where `point` is: about 1.
[[nodiscard]] float braid(const Curve& curve, const Surface& seen, const Eigen::Vector3f& point,
                          double radius_m);

/// [height, width, 3], black outside the windows; `materials` are the ropes'. The light, the
/// ground's texture and the camera's noise come from `dice`.
[[nodiscard]] std::vector<std::uint8_t> colored(
    const View& view, const Tracer& tracer, const Picture& picture, std::span<const Thing> things,
    std::span<const Rope> ropes, std::span<const Material* const> materials, bool lively,
    std::span<const Window> windows, Dice& dice);

}  // namespace flowdlo::synth
