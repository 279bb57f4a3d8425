// Overlay: the estimate drawn over the image, for a person to judge at a glance.
#pragma once

#include <string>

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/tracker.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

/// The colour image, dimmed (the mask where there is none), with the mask's outline, the curve, its
/// ends A and B, and a legend. The frame's size, or a whole multiple of it when the
/// frame is under 480 px wide. The strand nearer to the camera is drawn over the other. With
/// `strands` the image below shows what the strand field says: axes coloured by direction, tips
/// white. Of the curve the nodes alone are drawn then, so that it hides nothing.
[[nodiscard]] support::Picture draw_overlay(const Frame& frame, const Estimate& estimate,
                                            const std::string& device,
                                            const SeenStrands* strands = nullptr);

/// What the strand field says over the dimmed image, without a curve: axes coloured by direction,
/// tips white. The frame's size.
[[nodiscard]] support::Picture draw_field(const Frame& frame, const SeenStrands& strands);

/// The frame of which there is no estimate, with a sentence. As big as draw_overlay's.
[[nodiscard]] support::Picture draw_failure(const Frame& frame, const std::string& words);

/// draw_overlay of several ropes, each in its own colour, darker where nothing visible backs it,
/// its ends numbered; a ring has none. Colours and numbers are those that ropes keep through a
/// stream, and of a frame on its own their indices. At each crossing the upper rope is drawn over
/// the other.
[[nodiscard]] support::Picture draw_overlay(const Frame& frame, const TrackedRopes& tracked,
                                            const std::string& device);

}  // namespace flowdlo::tools
