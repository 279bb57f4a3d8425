#include "geometry/ring.hpp"

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::geometry {
namespace {

constexpr int kSegments = static_cast<int>(kNodes) - 1;  // once round
constexpr int kPartsOfSegment = 4;                       // of which a ring may begin at each
constexpr int kPlaces = kSegments * kPartsOfSegment;

/// Where a ring is told from, and which way round.
struct Beginning {
  int place = 0;
  int step = kPartsOfSegment;  // places between nodes; below 0: backwards

  /// Of node `i`, in [0, kPlaces).
  [[nodiscard]] int place_of(std::size_t i) const {
    const int at = (place + static_cast<int>(i) * step) % kPlaces;
    return at < 0 ? at + kPlaces : at;
  }
};

/// Places that divide the ring's length evenly, once round; the last is the first.
std::vector<Eigen::Vector3f> places_of(const Centerline& ring) {
  std::vector<Eigen::Vector3f> corners;
  for (const Point3& node : ring) corners.push_back(to_eigen(node));
  corners.push_back(corners.front());
  return resample(corners, kPlaces + 1);
}

Centerline told_from(const Beginning& from, const std::vector<Eigen::Vector3f>& places) {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = to_point(places[static_cast<std::size_t>(from.place_of(i))]);
  }
  return nodes;
}

/// Of nodes of the same index, metres, in all.
double distance_in_order(const Centerline& a, const Centerline& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) sum += distance(a[i], b[i]);
  return sum;
}

}  // namespace

ToldRing told_like(const Centerline& ring, const Centerline& other) {
  const auto places = places_of(ring);
  Beginning best;
  double least = std::numeric_limits<double>::max();
  const auto consider = [&](const Beginning& from) {
    const double off = distance_in_order(told_from(from, places), other);
    if (off < least) {
      least = off;
      best = from;
    }
  };
  for (const int step : {kPartsOfSegment, -kPartsOfSegment}) {
    for (int node = 0; node < kSegments; ++node) consider({node * kPartsOfSegment, step});
  }
  const Beginning whole = best;  // of whole nodes; then of the parts beside
  for (int part = 1 - kPartsOfSegment; part < kPartsOfSegment; ++part) {
    consider({whole.place + part, whole.step});
  }
  ToldRing told{.nodes = told_from(best, places),
                .reversed = best.step < 0,
                .begins = static_cast<double>(best.place_of(0)) / kPlaces};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const int nearest = (best.place_of(i) + kPartsOfSegment / 2) / kPartsOfSegment;
    told.from[i] = static_cast<std::size_t>(nearest % kSegments);
  }
  return told;
}

double mean_distance(const Centerline& a, const Centerline& b, bool rings) {
  return mean_distance(rings ? told_like(a, b).nodes : a, b);
}

}  // namespace flowdlo::geometry
