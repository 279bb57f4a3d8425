// TwoRopes: two frames of one rope each made one frame of two.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::lab {

enum class Arrangement {
  kCrossing,  ///< over or under each other
  kApart,     ///< at least two widths between them
  kTouching,  ///< one ends on the other's middle
  kJoined,    ///< one begins where the other ends, in the same direction
};

inline constexpr int kArrangements = 4;
inline constexpr float kTwoRopesScale = 0.65F;  ///< both are seen so much smaller

[[nodiscard]] std::string_view name_of(Arrangement arrangement);

/// Both seen from further away; `second` is turned and pushed over `first` by chance, and of both
/// ropes what is nearer is kept, in depth, mask and, where both have it, colour. Background and
/// truth are `first`'s. Nothing where no place is found, or where less than half of the second
/// rope stays in view. Deterministic. Both frames have truth.
[[nodiscard]] std::optional<FrameFolder> two_ropes(const FrameFolder& first,
                                                   const FrameFolder& second,
                                                   Arrangement arrangement, std::uint64_t seed);

}  // namespace flowdlo::lab
