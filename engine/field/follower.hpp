// Follower: a field's ridges as lines, each followed from its clearest point both ways.
#pragma once

#include <vector>

#include "field/axis_line.hpp"

namespace flowdlo::field {

/// Lines as they run, whatever they cross: at a crossing, where directions mix, one may have
/// changed over to the other strand. Clearest first; those shorter than three quarters of a rope's
/// width are left out. Tips are not looked for.
[[nodiscard]] std::vector<AxisLine> follow_ridges(const Channels& field);

}  // namespace flowdlo::field
