// Touches: where the links of a set of ways meet without crossing.
#pragma once

#include "path/search.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// How many pairs of links, of one way or of two, lie at one place and do not cross: each end of
/// one within kTouchWidths of an end of the other, and depth does not part them. There strands come
/// together, and the ways through them touch.
[[nodiscard]] int touches(const RopeSet& set, const Strands& strands);

inline constexpr float kTouchWidths = 2;

}  // namespace flowdlo::path
