// Energy: what a way through strands pays, term by term, where no network says it: strands of the
// mask alone, and which few links of a field's strands path/link_network is asked about. Free of
// units: the negative logarithm of how likely each choice is (up to what all choices share).
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
  kLinkUnshown,  ///< 1 - exp(-l / (2 w)), l: over which the mask is set but no strand of the field
                 ///< runs that way; 0 without a field
  kLinkColor,    ///< how much another colour one strand has than the other, in any light
  kLinkDepth,    ///< log(1 + r^2 / 2), r: how far the depths on both sides are from one smooth
                 ///< strand, over what noise makes of it
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
/// right one of all links is to be the likeliest; colour from the other fit, before it was compared
/// in any light; depth, whose fit says nothing, on scenes 3000000 to 3000599 by `flowdlo-lab
/// reading-report`.
inline constexpr LinkTerms kOneRopeLinks{1.0F, 1.05F, 0.95F, 2.0F, 3.4F, 0.8F, 0.3F, 0.0F};

/// Where a rope may as well end. Fitted by the same with `--first 3200000 --scenes 200 --several
/// 700`, as what stops cost; depth, whose fit says nothing, so that 12 cm of it outweigh a right
/// angle. What the mask says weighs 1.0 where the fit has 0.85 and 0.7. A stop costs 1.0 where the
/// fit has 0.1: a real rope behind a bar is parted with 0.8.
inline constexpr LinkTerms kSeveralRopesLinks{1.3F, 0.8F, 0.4F, 1.05F, 1.2F, 2.4F, 0.5F, 1.0F};
inline constexpr StopTerms kStopWeights{1.0F, 4.6F, 1.0F};

/// And of the only rope's end at the image's border. Where its tips show, it comes back into the
/// image; without this price its tips would be joined and it would end at the border. Chosen on
/// 2,000 `wide` training scenes from 5200000 on by `flowdlo-lab reading-report`: 0 is worse by
/// 0.015 cm (the best of the priors by 0.027), 1.5 and 4 are within 0.003.
inline constexpr float kLeavesEnergy = 2.5F;

/// Of each width of a strand that a path leaves out. Chosen on `wide` training scenes 3000500 to
/// 3000749 by `flowdlo-lab reading-report`: 1 is worse by 0.1 cm, 4 by 0.02.
inline constexpr float kLeftOutEnergy = 2.5F;

/// And, among several ropes, of two links that meet and do not cross (path/touches): strands that
/// come together rather cross than touch, and what looks like a ring beside a rope is a loop of it.
/// Chosen on drawn scenes without depth, drawn and rendered ones (docs/ropes.md): 0.25 and 2 are
/// worse.
inline constexpr float kTouchEnergy = 1.0F;

/// And of one that links close to a ring: few ropes are rings, and the inner turn of a coil looks
/// like one. Chosen on 184 rendered training scenes of several ropes, half of them tangled
/// (docs/ropes.md): 0 has two scenes fewer right, all of coils; 2.5 loses true rings.
inline constexpr float kRingEnergy = 1.0F;

/// And, where there may be several ropes, of one more that has two ends, beside what path/
/// link_network says of these: the scenes it is fitted to hold more ropes than most frames do. At 0
/// a real rope behind a dark bar is as likely two; 0.2 to 0.6 are alike on rendered and drawn
/// training scenes (docs/field.md).
inline constexpr float kOneMoreEnergy = 0.4F;

/// How much the end of a strand of the mask looks like the rope's own, where no field says it: a
/// tip in plain sight; one at which an occluder begins, or beyond which another strand passes. An
/// end at a crossing looks like none.
inline constexpr float kPlainTip = 1.0F;
inline constexpr float kCoveredTip = 0.3F;

template <std::size_t Count>
[[nodiscard]] float energy_of(const std::array<float, Count>& terms,
                              const std::array<float, Count>& weights) {
  float sum = 0;
  for (std::size_t i = 0; i < Count; ++i) sum += weights[i] * terms[i];
  return sum;
}

}  // namespace flowdlo::path
