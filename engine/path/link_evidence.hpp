// LinkEvidence: what a network (path/link_network) weighs of a link between two strands' ends, and
// of an end at which a rope may stop. All are free of units and about 1 in size; w is the rope's
// width there.
#pragma once

#include <array>
#include <cstddef>

#include "path/cover.hpp"
#include "path/link.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// Of an end by itself.
enum EndFeature : std::size_t {
  kEndTip,     ///< how much the field shows the rope's own end
  kEndHeard,   ///< how likely another reading goes on there
  kEndCut,     ///< 1: right behind it something nearer hides the rope
  kEndLeaves,  ///< 1: the image ends there
  kEndLength,  ///< log(1 + l / w), l: length of its strand
  kEndNear,    ///< what shows one, two and four widths ahead: 1 what hides, -1 what lies behind
  kEndMiddle,
  kEndFar,
  kEndMaskNear,  ///< 1: the mask is set one width ahead, two widths ahead
  kEndMaskMiddle,
  kEndDeep,     ///< 1: its depth is known
  kEndWidth,    ///< log2(w / 8 px)
  kEndSeveral,  ///< 1: there may be several ropes
  kEndFeatures
};
using EndFeatures = std::array<float, kEndFeatures>;

/// Of an end towards another one.
enum SideFeature : std::size_t {
  kSideTurn,    ///< from its outward tangent to the chord, of pi
  kSideHeads,   ///< the same from its heading
  kSideAside,   ///< log(1 + d / w), d: how far the other end lies beside its line
  kSideAhead,   ///< how far ahead of it, likewise; negative behind it
  kSideCurves,  ///< curvature times w, positive towards the other end
  kSideSlope,   ///< change of depth along it
  kSideFeatures
};
using SideFeatures = std::array<float, kSideFeatures>;

/// Of both.
enum PairFeature : std::size_t {
  kPairTerms,                            ///< those of the energy (path/energy.hpp)
  kPairChord = kPairTerms + kLinkTerms,  ///< log(1 + chord / w)
  kPairDetour,                           ///< log of the link's length over its chord
  kPairBend,                             ///< log(1 + B / 0.1)
  kPairTurn,                             ///< between both tangents, of pi
  kPairHidden,                           ///< shares of the link
  kPairOpen,
  kPairMasked,
  kPairShown,
  kPairBelow,
  kPairWorst,    ///< least that the field shows along it
  kPairOpenFar,  ///< log(1 + l / w) over which the background shows,
  kPairBare,     ///< over which the mask shows what the field does not
  kPairDeep,     ///< 1: both depths are known
  kPairApart,    ///< log(1 + d / w), d: difference of depths,
  kPairUneven,   ///< how far they are from one smooth strand
  kPairWidths,   ///< |log| of the ratio of both widths
  kPairOwn,      ///< 1: both ends of one strand
  kPairFeatures
};
using PairFeatures = std::array<float, kPairFeatures>;

/// `goes_on` is [0, 1] how likely another reading goes on from it to another strand.
[[nodiscard]] EndFeatures end_features(int end, const Strands& strands, const Cover& cover,
                                       float goes_on);

/// Of `from`, looking to `to`.
[[nodiscard]] SideFeatures side_features(int from, int to, const Strands& strands,
                                         const Cover& cover);

[[nodiscard]] PairFeatures pair_features(int from, int to, const Link& link, const Strands& strands,
                                         const Cover& cover);

}  // namespace flowdlo::path
