#include "synth/sensor.hpp"

#include <array>

namespace flowdlo::synth {
namespace {

constexpr auto kStereo = DepthPrinciple::kStereo;
constexpr auto kTof = DepthPrinciple::kTimeOfFlight;

// Focal lengths follow from the fields of view in public data sheets.
constexpr std::array<Sensor, 14> kSensors = {{
    {"realsense_d435 640x480", 640, 480, 607, kStereo, 0.050, 0.08, 0, 0.20, 6.0, 3},
    {"realsense_d435 848x480", 848, 480, 425, kStereo, 0.050, 0.08, 0, 0.20, 6.0, 2},
    {"realsense_d435 1280x720", 1280, 720, 911, kStereo, 0.050, 0.10, 0, 0.28, 6.0, 1.5},
    {"realsense_d435 1920x1080", 1920, 1080, 1366, kStereo, 0.050, 0.15, 0, 0.28, 6.0, 0.5},
    {"realsense_d415 640x480", 640, 480, 617, kStereo, 0.055, 0.06, 0, 0.30, 6.0, 1.5},
    {"realsense_d415 1280x720", 1280, 720, 925, kStereo, 0.055, 0.08, 0, 0.45, 6.0, 1.0},
    {"realsense_l515 640x480", 640, 480, 600, kTof, 0, 0, 0.0016, 0.25, 6.4, 1.5},
    {"realsense_l515 1024x768", 1024, 768, 731, kTof, 0, 0, 0.0016, 0.25, 6.4, 1.0},
    {"realsense_l515 1280x720", 1280, 720, 908, kTof, 0, 0, 0.0016, 0.25, 6.4, 0.5},
    {"azure_kinect 640x576", 640, 576, 504, kTof, 0, 0, 0.0020, 0.40, 5.5, 1.0},
    {"azure_kinect 1280x720", 1280, 720, 608, kTof, 0, 0, 0.0020, 0.40, 5.5, 2.0},
    {"azure_kinect 1920x1080", 1920, 1080, 912, kTof, 0, 0, 0.0020, 0.40, 5.5, 0.5},
    {"zed_2 1280x720", 1280, 720, 527, kStereo, 0.120, 0.15, 0, 0.30, 6.4, 1.0},
    {"zed_2 1920x1080", 1920, 1080, 1058, kStereo, 0.120, 0.25, 0, 0.30, 6.4, 0.4},
}};

}  // namespace

std::span<const Sensor> sensors() { return kSensors; }

const Sensor& thesis_sensor() { return kSensors.front(); }

const Sensor& draw_sensor(Dice& dice) {
  double sum = 0;
  for (const Sensor& sensor : kSensors) sum += sensor.weight;
  double left = dice.uniform(0, sum);
  for (const Sensor& sensor : kSensors) {
    if (left < sensor.weight) return sensor;
    left -= sensor.weight;
  }
  return kSensors.front();
}

Intrinsics intrinsics_of(const Sensor& sensor, Dice& dice) {
  const double focal = sensor.focal_px * dice.uniform(0.985, 1.015);
  return {
      static_cast<float>(focal), static_cast<float>(focal * dice.uniform(0.998, 1.002)),
      static_cast<float>(0.5 * (sensor.width - 1) + sensor.width * dice.uniform(-0.01, 0.01)),
      static_cast<float>(0.5 * (sensor.height - 1) + sensor.height * dice.uniform(-0.015, 0.015))};
}

}  // namespace flowdlo::synth
