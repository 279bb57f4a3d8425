// Energy: what a way through the strands that a field shows pays, term by term. Free of units: the
// negative logarithm of how likely each choice is (up to what all choices share).
#pragma once

#include <array>
#include <cstddef>

namespace flowdlo::path {

/// Of a link from one strand's end to another's, drawn as a cubic; w: the rope's width, L: length.
enum LinkTerm : std::size_t {
  kLinkLong,     ///< log(1 + L / (3 w))
  kLinkBend,     ///< log(1 + B / 0.1), B: L times the integral of (bend - the ends' own bend)^2
  kLinkStump,    ///< the same, as far as one strand is a stump whose direction is hardly known
  kLinkOpen,     ///< 1 - exp(-l / (0.3 w)), l: over which the background shows where a rope would
  kLinkUnshown,  ///< 1 - exp(-l / (2 w)), l: over which the mask is set but no strand runs that way
  kLinkColor,    ///< how much another colour one strand has than the other
  kLinkDepth,    ///< how badly the depths on both sides fit one smooth strand
  kLinkHeard,  ///< how likely one of both ends goes on elsewhere, by the reading of the mask alone
  kLinkTerms
};
using LinkTerms = std::array<float, kLinkTerms>;

/// Of an end of the rope.
enum StopTerm : std::size_t {
  kStopStart,   ///< 1
  kStopUnseen,  ///< how little it looks like a rope's end; 0 at the image's border
  kStopHeard,   ///< how likely the rope goes on there, by the reading of the mask alone
  kStopTerms
};
using StopTerms = std::array<float, kStopTerms>;

/// Of one rope's way, which has two ends whatever they cost. Fitted by `flowdlo-lab energy-fit` to
/// the ends of strands in 900 `wide` training scenes of one rope (from 3200000 on), of which the
/// right one of all links is to be the likeliest; colour and depth as below.
inline constexpr LinkTerms kOneRopeLinks{1.0F, 1.05F, 0.95F, 2.0F, 3.4F, 0.8F, 1.0F, 0.0F};

/// Where a rope may as well end. Fitted by the same with `--first 3200000 --scenes 200 --several
/// 700`, as what stops cost.
inline constexpr LinkTerms kSeveralRopesLinks{2.1F, 1.0F, 0.4F, 2.0F, 1.7F, 1.0F, 1.05F, 1.0F};
inline constexpr StopTerms kStopWeights{1.6F, 4.7F, 1.0F};

/// Of each width of a strand that a path leaves out. Chosen on `wide` training scenes 3000500 to
/// 3000749 by `flowdlo-lab reading-report`: 1 is worse by 0.1 cm, 4 by 0.02.
inline constexpr float kLeftOutEnergy = 2.5F;

template <std::size_t Count>
[[nodiscard]] float energy_of(const std::array<float, Count>& terms,
                              const std::array<float, Count>& weights) {
  float sum = 0;
  for (std::size_t i = 0; i < Count; ++i) sum += weights[i] * terms[i];
  return sum;
}

}  // namespace flowdlo::path
