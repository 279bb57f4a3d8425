// MaskSegmenter: what a segmenter makes of the true mask.
#pragma once

#include <cstdint>
#include <vector>

#include "synth/faults.hpp"
#include "synth/tracer.hpp"

namespace flowdlo::synth {

/// [height, width], 0 or 1 + which rope a pixel sees.
[[nodiscard]] std::vector<std::uint16_t> labels_of(const Picture& ideal);

/// [height, width], 0 or 255.
[[nodiscard]] std::vector<std::uint8_t> segmented_mask(const View& view, const Picture& ideal,
                                                       const MaskFaults& faults,
                                                       std::uint32_t seed);

}  // namespace flowdlo::synth
