// Findings: what can be measured on a finished frame, for its Meta.
#pragma once

#include <span>
#include <vector>

#include "synth/faults.hpp"
#include "synth/synthetic_frame.hpp"
#include "synth/tracer.hpp"

namespace flowdlo::synth {

/// Fills lengths, shares, crossings and the measured flags of `meta`; `rope` is the first one.
void find(const View& view, const Rope& rope, const Picture& ideal, std::span<const float> depth_m,
          std::span<const std::uint8_t> mask, Meta& meta);

/// Sets the flags of what the scene maker did, where it left a trace.
void note(const Faults& faults, std::span<const Thing> things, const Picture& ideal,
          std::span<const float> depth_m, std::span<const std::uint8_t> mask, Meta& meta);

}  // namespace flowdlo::synth
