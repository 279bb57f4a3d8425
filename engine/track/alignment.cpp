#include "track/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"

namespace flowdlo::track {
namespace {

double distance_m(const Centerline& told, const Centerline& known) {
  double sum_m = 0;
  for (std::size_t i = 0; i < kNodes; ++i) sum_m += geometry::distance(told[i], known[i]) / kNodes;
  return sum_m;
}

template <class Values>
Values turned(const Values& values, const Alignment& alignment) {
  Values result{};
  for (std::size_t i = 0; i < kNodes; ++i) result[i] = values[alignment.from[i]];
  return result;
}

Alignment as_it_is(const Centerline& found, const Centerline& known) {
  Alignment same{.nodes = found, .apart_m = distance_m(found, known)};
  std::iota(same.from.begin(), same.from.end(), std::size_t{0});
  return same;
}

Alignment from_other_end(const Centerline& found, const Centerline& known) {
  Alignment other = as_it_is(found, known);
  std::reverse(other.nodes.begin(), other.nodes.end());
  std::reverse(other.from.begin(), other.from.end());
  other.reversed = true;
  other.apart_m = distance_m(other.nodes, known);
  return other;
}

Alignment round_a_ring(const Centerline& found, const Centerline& known) {
  const geometry::ToldRing told = geometry::told_like(found, known);
  return {.nodes = told.nodes,
          .from = told.from,
          .reversed = told.reversed,
          .begins = told.begins,
          .apart_m = distance_m(told.nodes, known)};
}

}  // namespace

Alignment align(const Centerline& found, bool closed, const Centerline& known) {
  const Alignment same = as_it_is(found, known);
  if (!std::isfinite(same.apart_m)) return same;
  const Alignment other = closed ? round_a_ring(found, known) : from_other_end(found, known);
  return other.apart_m < same.apart_m ? other : same;
}

void turn(Estimate& estimate, const Alignment& alignment, const Centerline& known) {
  estimate.nodes = alignment.nodes;
  estimate.support = turned(estimate.support, alignment);
  estimate.sigma_m = turned(estimate.sigma_m, alignment);
  for (Alternative& other : estimate.alternatives) {
    other.nodes = align(other.nodes, false, known).nodes;
  }
  estimate.reversed = estimate.reversed != alignment.reversed;
}

double turned_m(double at_m, const Centerline& nodes, bool closed, const Alignment& alignment) {
  const auto length_m = static_cast<double>(geometry::length(nodes));
  if (!closed) {
    return std::clamp(alignment.reversed ? length_m - at_m : at_m, 0.0, length_m);
  }
  const double round_m = length_m + geometry::distance(nodes.back(), nodes.front());
  const double from_m = alignment.begins * round_m;
  const double told_m = alignment.reversed ? from_m - at_m : at_m - from_m;
  return told_m < 0 ? told_m + round_m : told_m;
}

}  // namespace flowdlo::track
