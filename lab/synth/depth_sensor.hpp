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

}  // namespace flowdlo::synth
