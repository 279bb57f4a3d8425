// The arclength of a sighting is that of the closest position on the path's segments. Near a
// crossing several strands are close; spec section 4 lets depth choose among them:
//
//   - a sighting near one strand only is unambiguous and says how deep that strand is there;
//   - at an ambiguous one, each strand's depth is predicted from the unambiguous sightings along
//   it;
//   - the strand of least cost takes it:
//     (depth misfit / kDepthSpread_m)^2 + (distance / (radius / 2))^2.
//
// Depth decides where the strands differ by more than its noise, nearness where they do not. A
// strand that nobody saw alone counts as off by kUnknownMisfit_m; with no evidence at all the
// nearest strand wins, ties going to the lower arclength.
#include "prior/association.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace flowdlo::prior {
namespace {

constexpr float kNowhere = -1.0F;          // no arclength
constexpr float kDepthSpread_m = 0.003F;   // sensor noise and the rope's own roundness
constexpr float kUnknownMisfit_m = 0.01F;  // about a rope's diameter
constexpr float kReachInSigmas = 3.0F;     // of the neighbours that predict a depth
constexpr std::size_t kBlock = 16;         // segments that share a bounding box

/// A position on the path near a sighting.
struct Hit {
  std::size_t segment;
  float arclength_px;
  float distance_px;
};

/// The path with bounding boxes over kBlock segments, so that a query looks at few of them.
class IndexedPath {
 public:
  IndexedPath(std::span<const Eigen::Vector2f> points_px, std::span<const float> arclength_px)
      : points_px_(points_px), arclength_px_(arclength_px) {
    for (std::size_t first = 0; first + 1 < points_px.size(); first += kBlock) {
      Eigen::AlignedBox2f& box = boxes_.emplace_back();
      const std::size_t last = std::min(points_px.size() - 1, first + kBlock);
      for (std::size_t i = first; i <= last; ++i) box.extend(points_px[i]);
    }
  }

  /// Closest position of every segment within `radius_px`, in path order.
  void near(const Eigen::Vector2f& position_px, float radius_px, std::vector<Hit>& hits) const {
    hits.clear();
    for (std::size_t block = 0; block < boxes_.size(); ++block) {
      if (boxes_[block].squaredExteriorDistance(position_px) > radius_px * radius_px) continue;
      const std::size_t end = std::min(points_px_.size() - 1, (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < end; ++i) {
        const Hit hit = closest(i, position_px);
        if (hit.distance_px <= radius_px) hits.push_back(hit);
      }
    }
  }

 private:
  [[nodiscard]] Hit closest(std::size_t segment, const Eigen::Vector2f& position_px) const {
    const Eigen::Vector2f start = points_px_[segment];
    const Eigen::Vector2f along = points_px_[segment + 1] - start;
    const float squared = along.squaredNorm();
    const float alpha =
        squared > 0 ? std::clamp((position_px - start).dot(along) / squared, 0.0F, 1.0F) : 0.0F;
    const float length = arclength_px_[segment + 1] - arclength_px_[segment];
    return {segment, arclength_px_[segment] + alpha * length,
            (position_px - start - alpha * along).norm()};
  }

  std::span<const Eigen::Vector2f> points_px_;
  std::span<const float> arclength_px_;
  std::vector<Eigen::AlignedBox2f> boxes_;
};

/// The strands among `hits`: local minima of the distance along the path, nearest first; of minima
/// within `arc_window_px` of each other only the nearest counts.
void find_strands(const std::vector<Hit>& hits, float arc_window_px, std::vector<Hit>& strands) {
  std::vector<Hit> minima;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool follows = i > 0 && hits[i - 1].segment + 1 == hits[i].segment;
    const bool leads = i + 1 < hits.size() && hits[i + 1].segment == hits[i].segment + 1;
    if (follows && hits[i - 1].distance_px <= hits[i].distance_px) continue;
    if (leads && hits[i + 1].distance_px < hits[i].distance_px) continue;
    minima.push_back(hits[i]);
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const Hit& a, const Hit& b) { return a.distance_px < b.distance_px; });
  strands.clear();
  for (const Hit& minimum : minima) {
    const bool taken = std::any_of(strands.begin(), strands.end(), [&](const Hit& strand) {
      return std::abs(strand.arclength_px - minimum.arclength_px) <= arc_window_px;
    });
    if (!taken) strands.push_back(minimum);
  }
}

/// An unambiguous sighting.
struct Witness {
  float arclength_px;
  float depth_m;
  float weight;
};

/// One side's view of a strand: medians of arclength and depth, Gaussian-weighted.
struct Side {
  float arclength_px;
  float depth_m;
};

float weighted_median(std::vector<Witness>& witnesses, float Witness::*value) {
  std::sort(witnesses.begin(), witnesses.end(), [value](const Witness& a, const Witness& b) {
    return std::array{a.*value, a.weight} < std::array{b.*value, b.weight};
  });
  float total = 0;
  for (const Witness& witness : witnesses) total += witness.weight;
  float below = 0;
  for (const Witness& witness : witnesses) {
    below += witness.weight;
    if (2 * below >= total) return witness.*value;
  }
  return witnesses.back().*value;
}

/// Predicts a strand's depth from the unambiguous sightings along the path.
class StrandDepth {
 public:
  StrandDepth(std::vector<Witness> witnesses, float sigma_px)
      : witnesses_(std::move(witnesses)), sigma_px_(sigma_px) {
    std::sort(witnesses_.begin(), witnesses_.end(), [](const Witness& a, const Witness& b) {
      return std::array{a.arclength_px, a.depth_m} < std::array{b.arclength_px, b.depth_m};
    });
  }

  /// Linear between both sides' medians, so that a slope along the strand cancels; the one side's
  /// median at a gap; nothing when no witness is within reach.
  [[nodiscard]] std::optional<float> at(float arclength_px) const {
    const float reach_px = kReachInSigmas * sigma_px_;
    const auto before = side(arclength_px, arclength_px - reach_px, arclength_px);
    const auto after = side(arclength_px, arclength_px, arclength_px + reach_px);
    if (!before && !after) return std::nullopt;
    if (!before) return after->depth_m;
    if (!after) return before->depth_m;
    const float span = after->arclength_px - before->arclength_px;
    const float alpha = span > 0 ? (arclength_px - before->arclength_px) / span : 0.5F;
    return before->depth_m + alpha * (after->depth_m - before->depth_m);
  }

 private:
  [[nodiscard]] std::optional<Side> side(float centre_px, float from_px, float to_px) const {
    std::vector<Witness> seen;
    auto witness = std::lower_bound(
        witnesses_.begin(), witnesses_.end(), from_px,
        [](const Witness& entry, float arclength) { return entry.arclength_px < arclength; });
    for (; witness != witnesses_.end() && witness->arclength_px <= to_px; ++witness) {
      const float offset = (witness->arclength_px - centre_px) / sigma_px_;
      seen.push_back({witness->arclength_px, witness->depth_m, std::exp(-0.5F * offset * offset)});
    }
    if (seen.empty()) return std::nullopt;
    const float arclength_px = weighted_median(seen, &Witness::arclength_px);
    return Side{arclength_px, weighted_median(seen, &Witness::depth_m)};
  }

  std::vector<Witness> witnesses_;
  float sigma_px_;
};

float choose(const std::vector<Hit>& strands, float depth_m, const StrandDepth& strand_depth,
             float radius_px) {
  float best = kNowhere;
  float best_cost = std::numeric_limits<float>::infinity();
  for (const Hit& strand : strands) {
    const std::optional<float> expected_m = strand_depth.at(strand.arclength_px);
    const float misfit =
        (expected_m ? std::abs(depth_m - *expected_m) : kUnknownMisfit_m) / kDepthSpread_m;
    const float distance = strand.distance_px / (radius_px / 2);
    const float cost = misfit * misfit + distance * distance;
    if (cost < best_cost) {
      best_cost = cost;
      best = strand.arclength_px;
    }
  }
  return best;
}

}  // namespace

std::vector<float> associate(std::span<const Eigen::Vector2f> path_px,
                             std::span<const float> arclength_px,
                             std::span<const Sighting> sightings, float radius_px,
                             float arc_window_px) {
  const IndexedPath path(path_px, arclength_px);
  std::vector<float> result(sightings.size(), kNowhere);
  std::vector<std::vector<Hit>> strands(sightings.size());
  std::vector<Witness> witnesses;
  std::vector<Hit> hits;
  for (std::size_t j = 0; j < sightings.size(); ++j) {
    path.near(sightings[j].position_px, radius_px, hits);
    find_strands(hits, arc_window_px, strands[j]);
    if (strands[j].size() != 1) continue;
    result[j] = strands[j].front().arclength_px;
    witnesses.push_back({result[j], sightings[j].depth_m, 1});
  }
  const StrandDepth strand_depth(std::move(witnesses), arc_window_px);
  for (std::size_t j = 0; j < sightings.size(); ++j) {
    if (strands[j].size() < 2) continue;
    result[j] = choose(strands[j], sightings[j].depth_m, strand_depth, radius_px);
  }
  return result;
}

}  // namespace flowdlo::prior
