// StereoPair: depth as a stereo camera comes by it. Two infrared pictures of the scene are
// rendered, matched by semi-global matching, and what that gives is seen from the colour camera.
//
// A noise model shows what such a camera does to a plane. Matching also shows what it does to a
// rope: windows that hold rope and background mix the two, one eye sees what the other does not,
// and what is thinner than a window is lost or pulled back.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flowdlo/result.hpp"
#include "synth/dice.hpp"
#include "synth/tracer.hpp"

namespace flowdlo::synth {

/// The infrared half of a camera. Both eyes look the way the colour camera looks, side by side.
struct StereoRig {
  int width = 848;        ///< pixels of an eye
  int height = 480;       ///< likewise
  double focal_px = 425;  ///< of an eye
  double left_m = 0;      ///< the left eye, along u from the colour camera
  double baseline_m = 0;  ///< from the left eye to the right one
  double dots_m = 0;      ///< the projector of dots, along u from the left eye
  bool has_dots = false;  ///< else there is no projector
};

/// None for what is no stereo camera.
[[nodiscard]] std::optional<StereoRig> rig_of(const Sensor& sensor);

/// One eye's picture [height, width], 0 to 255.
struct EyePicture {
  std::vector<std::uint8_t> left;
  std::vector<std::uint8_t> right;
};

/// What both eyes see, with dots where the rig has a projector. Surfaces, light and the eyes' noise
/// come from `dice`. Fails as Tracer::create does.
[[nodiscard]] Result<EyePicture> infrared(const View& view, const StereoRig& rig,
                                          std::span<const Rope> ropes,
                                          std::span<const Thing> things, Dice& dice);

/// [height, width] of `view`, metres, 0: none. `nearest_m`: nothing is nearer. Fails with kBadInput
/// where FlowDLO was built without OpenCV's calib3d.
[[nodiscard]] Result<std::vector<float>> matched(const View& view, const StereoRig& rig,
                                                 const EyePicture& eyes, double nearest_m);

}  // namespace flowdlo::synth
