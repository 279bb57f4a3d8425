#include "geometry/ring.hpp"

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::geometry {
namespace {

constexpr int kCount = static_cast<int>(kNodes);
constexpr int kSegments = kCount - 1;  // once round
constexpr int kPartsOfNode = 4;  // of the way from node to node: places where a ring may begin

/// Where a ring is told from, and which way round: in parts of the way from node to node.
struct Beginning {
  int at = 0;
  int step = kPartsOfNode;  // or less than 0: backwards
};

/// A ring at places that divide its length evenly, the first one once more at the end.
class Round {
 public:
  explicit Round(const Centerline& ring) {
    for (const Point3& node : ring) corners_.push_back(to_eigen(node));
    corners_.push_back(corners_.front());
    places_ = resample(corners_, kSegments * kPartsOfNode + 1);
  }

  [[nodiscard]] const Eigen::Vector3f& node(const Beginning& from, int i) const {
    constexpr int kPlaces = kSegments * kPartsOfNode;
    const int at = (from.at + i * from.step) % kPlaces;
    return places_[static_cast<std::size_t>(at < 0 ? at + kPlaces : at)];
  }

  /// In order, metres, of the sum over all nodes.
  [[nodiscard]] double distance_to(const Centerline& other, const Beginning& from) const {
    double sum = 0;
    for (int i = 0; i < kCount; ++i) {
      const Eigen::Vector3f off = node(from, i) - to_eigen(other[static_cast<std::size_t>(i)]);
      sum += static_cast<double>(off.norm());
    }
    return sum;
  }

  /// The corner that is nearest along the ring.
  [[nodiscard]] std::size_t corner_at(const Beginning& from, int i) const {
    const Eigen::Vector3f& place = node(from, i);
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < kNodes; ++k) {
      if ((corners_[k] - place).squaredNorm() < (corners_[nearest] - place).squaredNorm()) {
        nearest = k;
      }
    }
    return nearest;
  }

 private:
  std::vector<Eigen::Vector3f> corners_;
  std::vector<Eigen::Vector3f> places_;
};

}  // namespace

ToldRing told_like(const Centerline& ring, const Centerline& other) {
  const Round round(ring);
  Beginning best;
  double least = std::numeric_limits<double>::max();
  const auto consider = [&](const Beginning& from) {
    const double off = round.distance_to(other, from);
    if (off < least) {
      least = off;
      best = from;
    }
  };
  for (const int step : {kPartsOfNode, -kPartsOfNode}) {
    for (int node = 0; node < kSegments; ++node) consider({node * kPartsOfNode, step});
  }
  const Beginning whole = best;  // of whole nodes; then of the parts beside
  for (int part = 1 - kPartsOfNode; part < kPartsOfNode; ++part) {
    consider({whole.at + part, whole.step});
  }
  ToldRing told;
  for (int i = 0; i < kCount; ++i) {
    const auto node = static_cast<std::size_t>(i);
    told.nodes[node] = to_point(round.node(best, i));
    told.from[node] = round.corner_at(best, i);
  }
  return told;
}

double mean_distance(const Centerline& a, const Centerline& b, bool rings) {
  return mean_distance(rings ? told_like(a, b).nodes : a, b);
}

}  // namespace flowdlo::geometry
