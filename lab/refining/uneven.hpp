// Uneven: a scene whose surfaces are wavy, as a cloth is: each of its points moved along its ray.
// Rope and what it lies on move alike, and the picture stays what it was. Without such scenes a
// network would learn that all tables are planes.
#pragma once

#include <cstdint>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::refining {

/// Moves depths and the first rope's truth by waves of 1 to 8 mm and 3 to 30 cm, by `seed`.
void make_uneven(std::uint64_t seed, synth::SyntheticFrame& scene);

}  // namespace flowdlo::refining
