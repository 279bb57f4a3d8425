// Overlaps: where strands lie on each other. Two ropes cannot be at one place. Lines of a strand
// field that run within each other's width are one rope that was seen twice: the two plies of a
// cord, each taken for a rope, or two readings of one thick rope.
#pragma once

#include <cstdint>
#include <vector>

#include "path/strands.hpp"

namespace flowdlo::path {

/// Two strands lie on each other where they run the same way, nearer than this share of the
/// distance at which ropes of their widths touch. Chosen on 120 frames of several ropes of another
/// renderer (docs/ropes.md): of 0.75, 0.9 and 1.05 it makes the most of them wholly right.
inline constexpr float kOnEachOther = 0.9F;

/// Which of each strand's points others lie on. Strands are not changed after that.
class Overlaps {
 public:
  explicit Overlaps(const Strands& strands);

  /// [0, 1] the share of a strand's points that no strand of `used` [strands] lies on, other than
  /// itself; 1 of a strand without points.
  [[nodiscard]] float bare_share(int strand, const std::vector<std::uint8_t>& used) const;

 private:
  std::vector<std::vector<std::vector<int>>> on_;  // [strands][points] which others lie there
};

}  // namespace flowdlo::path
