// Choices: what might happen at the ends of a scene's strands. Each known end might go on with any
// other that a link leads to, or stop, and the ends that this frees would stop; what the rope
// really does is to cost less than every such change.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "link_fit/sample.hpp"

namespace flowdlo::lab {

/// Adds or takes away what one thing costs: the stop at end i is thing i, link i comes behind all
/// stops.
struct Change {
  std::size_t thing = 0;
  double sign = 1;
};

/// Each option is what changes; the first changes nothing and is right.
struct EndChoice {
  std::vector<std::vector<Change>> options;
};

[[nodiscard]] std::vector<EndChoice> choices_of(const LinkSample& sample);

/// [stops, then links] whether each is there in truth; known of those whose ends are known.
struct Truths {
  std::vector<bool> known;
  std::vector<bool> there;
};
[[nodiscard]] Truths truths_of(const LinkSample& sample);

/// Of a choice, where things cost that much.
struct Judged {
  double unlikely = 0;  ///< negative logarithm of how likely the right option is
  bool right = false;   ///< it is the likeliest
};

/// Adds to `slopes` [things], where there are any, what `unlikely` rises by with each cost.
[[nodiscard]] Judged judge(const EndChoice& choice, std::span<const double> costs,
                           std::span<double> slopes);

}  // namespace flowdlo::lab
