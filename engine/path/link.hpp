// Link: how a rope may go on from one strand's end to another's, through a crossing or across a
// gap, where no line joins them.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "path/cover.hpp"
#include "path/end_curve.hpp"
#include "path/energy.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

struct Link {
  LinkTerms terms{};
  float energy = std::numeric_limits<float>::max();
  EndCurve curve{};
};

/// What a link is judged by beside its curve.
struct LinkConfig {
  LinkTerms weights{};
  float scale_px = 1;   ///< the rope's width, in which lengths are measured
  float trust = 1;      ///< [0, 1] in the directions of both ends
  float elsewhere = 0;  ///< kLinkHeard
};

/// How far the depths on both sides, which must be known, are from one smooth strand; metres.
[[nodiscard]] float uneven_m(const StrandEnd& from, const StrandEnd& to);

/// The cheapest cubic from one end to another; energy from `most` on: none that costs less.
/// `cover` sees the field, where there is one.
[[nodiscard]] Link best_link(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                             const LinkConfig& config,
                             float most = std::numeric_limits<float>::max());

/// The curve of the best link, its tangents improved: points about a pixel apart, without the ends.
[[nodiscard]] std::vector<Eigen::Vector2f> link_points(const StrandEnd& from, const StrandEnd& to,
                                                       const Cover& cover,
                                                       const LinkConfig& config);

/// The least energy of a link so long.
[[nodiscard]] float least_energy(float length_px, const LinkTerms& weights, float scale_px);

}  // namespace flowdlo::path
