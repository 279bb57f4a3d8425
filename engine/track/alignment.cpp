#include "track/alignment.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/polyline.hpp"

namespace flowdlo::track {
namespace {

double distance_m(const Centerline& found, const Centerline& known, const Alignment& alignment) {
  double sum_m = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    sum_m += geometry::distance(found[alignment.found(i)], known[i]) / kNodes;
  }
  return sum_m;
}

template <class Values>
Values turned(const Values& values, const Alignment& alignment) {
  Values result{};
  for (std::size_t i = 0; i < kNodes; ++i) result[i] = values[alignment.found(i)];
  return result;
}

/// Metres from node 0 to `node`.
double along_m(const Centerline& nodes, std::size_t node) {
  double sum_m = 0;
  for (std::size_t i = 1; i <= node; ++i) sum_m += geometry::distance(nodes[i - 1], nodes[i]);
  return sum_m;
}

}  // namespace

Alignment align(const Centerline& found, bool closed, const Centerline& known) {
  Alignment best;
  best.apart_m = distance_m(found, known, best);
  for (const bool reversed : {false, true}) {
    for (std::size_t first = 0; first < kNodes; ++first) {
      if (!closed && first != (reversed ? kNodes - 1 : 0)) continue;
      Alignment other{first, reversed};
      other.apart_m = distance_m(found, known, other);
      if (other.apart_m < best.apart_m) best = other;
    }
  }
  return best;
}

void turn(Estimate& estimate, const Alignment& alignment) {
  estimate.nodes = turned(estimate.nodes, alignment);
  estimate.support = turned(estimate.support, alignment);
  estimate.sigma_m = turned(estimate.sigma_m, alignment);
  estimate.reversed = estimate.reversed != alignment.reversed;
}

double turned_m(double at_m, const Centerline& nodes, bool closed, const Alignment& alignment) {
  const double from_m = along_m(nodes, alignment.first);
  const double told_m = alignment.reversed ? from_m - at_m : at_m - from_m;
  const double whole_m =
      along_m(nodes, kNodes - 1) + (closed ? geometry::distance(nodes.back(), nodes.front()) : 0);
  if (told_m >= 0 || !closed) return std::clamp(told_m, 0.0, whole_m);
  return told_m + whole_m;
}

}  // namespace flowdlo::track
