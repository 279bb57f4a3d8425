// Loops: which ring of a set is more likely a loop of a rope that touches it.
#pragma once

#include "path/search.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// Whether a closed way of `set` links up right beside a link of another way, and crosses none.
/// What a rope lies on it crosses, mostly twice; where two ways only touch, with a link each, they
/// may as well have changed over: one rope, with a loop.
[[nodiscard]] bool may_be_loop(const Traversal& ring, const RopeSet& set, const Strands& strands);

}  // namespace flowdlo::path
