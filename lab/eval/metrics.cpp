#include "eval/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <tuple>

#include "geometry/polyline.hpp"

namespace flowdlo::eval {
namespace {

using geometry::distance;

constexpr double kStrandShare = 0.1;  // of the length, along the rope

}  // namespace

double index_error_m(const Centerline& nodes, const Centerline& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) sum += distance(nodes[i], truth[i]);
  return sum / kNodes;  // Eq. (4.1)
}

double frechet_m(const Centerline& nodes, const Centerline& truth) {
  std::array<double, kNodes> before{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    std::array<double, kNodes> now{};
    for (std::size_t j = 0; j < kNodes; ++j) {
      const double here = distance(nodes[i], truth[j]);
      double way = here;  // the least that any coupling up to (i, j) has to span, Eq. (4.2)
      if (i > 0 && j > 0) {
        way = std::max(here, std::min({before[j], before[j - 1], now[j - 1]}));
      } else if (i > 0) {
        way = std::max(here, before[j]);
      } else if (j > 0) {
        way = std::max(here, now[j - 1]);
      }
      now[j] = way;
    }
    before = now;
  }
  return before.back();
}

double strand_errors(const Centerline& nodes, const Centerline& truth) {
  int wrong = 0;
  for (int i = 0; i < kNodes; ++i) {
    const Point3& node = nodes[static_cast<std::size_t>(i)];
    const auto nearest = std::min_element(
        truth.begin(), truth.end(),
        [&](const Point3& a, const Point3& b) { return distance(a, node) < distance(b, node); });
    const int off = std::abs(static_cast<int>(nearest - truth.begin()) - i);
    wrong += off > kStrandShare * (kNodes - 1) ? 1 : 0;  // true nodes are uniform in arclength
  }
  return static_cast<double>(wrong) / kNodes;
}

Centerline reversed(const Centerline& nodes) {
  Centerline back = nodes;
  std::reverse(back.begin(), back.end());
  return back;
}

Centerline canonical(const Centerline& nodes) {
  const Point3& first = nodes.front();
  const Point3& last = nodes.back();
  const bool forward = std::tie(first.x, first.y, first.z) <= std::tie(last.x, last.y, last.z);
  return forward ? nodes : reversed(nodes);
}

Score score(const Centerline& nodes, const Centerline& truth) {
  const Centerline forward = canonical(truth);
  const Centerline backward = reversed(forward);
  Score score;
  score.index_m = index_error_m(nodes, forward);
  score.frechet_m = frechet_m(nodes, forward);
  const double other_m = index_error_m(nodes, backward);
  score.flipped = other_m < score.index_m;
  score.either_index_m = std::min(score.index_m, other_m);  // Eq. (4.3)
  score.strand_errors = strand_errors(nodes, score.flipped ? backward : forward);
  return score;
}

Centerline turned(const Centerline& truth, const Score& score) {
  return score.flipped ? reversed(canonical(truth)) : canonical(truth);
}

}  // namespace flowdlo::eval
