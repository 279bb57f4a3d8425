// DepthSensor: what a depth camera reports of an ideal picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "synth/faults.hpp"
#include "synth/synthetic_frame.hpp"
#include "synth/tracer.hpp"

namespace flowdlo::synth {

/// [height, width], metres, 0: none.
[[nodiscard]] std::vector<float> measured_depth(const View& view, const Picture& ideal,
                                                std::span<const Rope> ropes,
                                                const DepthFaults& faults, std::uint32_t seed);

/// The same of a depth image that was matched from two pictures, and so has its noise and its edges
/// already: what the rope's surface and the sensor's holes take from it.
[[nodiscard]] std::vector<float> spoiled_depth(const View& view, const Picture& ideal,
                                               std::span<const Rope> ropes,
                                               const DepthFaults& faults,
                                               std::vector<float> depth_m, std::uint32_t seed);

}  // namespace flowdlo::synth
