// The overlay's legend: source, confidence, mask agreement, device, and what the colours mean.
#pragma once

#include <cstddef>
#include <string>

#include "flowdlo/estimate.hpp"
#include "flowdlo/tracker.hpp"
#include "overlay_style.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

/// Draws the legend into the corner of `picture` where it covers least of `rope` (the picture's
/// size, set where the rope or the curve is).
void draw_legend(support::Picture& picture, const image::Mask& rope, const Estimate& estimate,
                 const std::string& device, const OverlayStyle& style);

/// A sentence in its place.
void draw_legend(support::Picture& picture, const image::Mask& rope, const std::string& words,
                 const OverlayStyle& style);

/// The same of several ropes: how many, how sure of the least sure one, the device, and each rope's
/// colour by its number.
void draw_legend(support::Picture& picture, const image::Mask& rope, const TrackedRopes& tracked,
                 const std::string& device, const OverlayStyle& style);

/// The number that a rope keeps through a stream; of a frame on its own, its index.
[[nodiscard]] int shown_number(const TrackedRopes& tracked, std::size_t rope);

/// Which of `rope_color` a rope has.
[[nodiscard]] std::size_t paint_index(const TrackedRopes& tracked, std::size_t rope);

}  // namespace flowdlo::tools
