// Sensor: common depth cameras, as their makers and users describe them.
#pragma once

#include <span>
#include <string_view>

#include "flowdlo/frame.hpp"
#include "synth/dice.hpp"

namespace flowdlo::synth {

enum class DepthPrinciple { kStereo, kTimeOfFlight };

/// One mode of a camera, depth aligned to the image whose intrinsics stand here.
struct Sensor {
  std::string_view name;
  int width = 640;
  int height = 480;
  double focal_px = 600;
  DepthPrinciple principle = DepthPrinciple::kStereo;
  double baseline_m = 0.05;    ///< stereo
  double disparity_px = 0.08;  ///< stereo: standard deviation of the disparity
  double noise_m = 0.0015;     ///< time of flight: standard deviation at 1 m
  double nearest_m = 0.25;
  double farthest_m = 6.0;
  double weight = 1;  ///< how often it is drawn
};

[[nodiscard]] std::span<const Sensor> sensors();

/// The sensor of the thesis split: 640 x 480.
[[nodiscard]] const Sensor& thesis_sensor();

/// A sensor, in proportion to its weight.
[[nodiscard]] const Sensor& draw_sensor(Dice& dice);

/// Its intrinsics, each copy of a camera a little different.
[[nodiscard]] Intrinsics intrinsics_of(const Sensor& sensor, Dice& dice);

}  // namespace flowdlo::synth
