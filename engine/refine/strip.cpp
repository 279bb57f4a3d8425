#include "refine/strip.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"
#include "refine/local_frame.hpp"
#include "refine/table.hpp"

namespace flowdlo::refine {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

static_assert(kColumnsUsed <= weights::kRefineInputs);

constexpr float kLeastWidth_px = 1;
constexpr float kMostWidth_px = 200;
constexpr std::array kBeyond{0.75F, 1.5F};  // of the outermost stations, widths beyond the end
constexpr float kLeastChord_px = 1e-6F;
constexpr float kNearTable = 2.5F;  // misfits, and a radius in any case
constexpr float kLies = 0.25F;      // share of nodes near it for a rope that may lie on the table
constexpr float kMostOff = 6;       // misfits that are told apart
constexpr std::size_t kLeastSeen = 4;  // nodes with support that say how a rope lies

struct Station {
  Vector2f px{0, 0};
  Vector2f along{1, 0};
  float depth_m = 0;
  float width_px = 0;
  float slope = 0;
};

Station station_at(const Curve& curve, float s, const Frame& frame) {
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(s), kNodes - 2);
  const Vector3f from = geometry::to_eigen(curve.nodes[i]);
  const Vector3f step = geometry::to_eigen(curve.nodes[i + 1]) - from;
  const Vector3f p = from + (s - static_cast<float>(i)) * step;
  Station station;
  station.px = geometry::project(frame.intrinsics, geometry::to_point(p));
  station.depth_m = p.z();
  station.width_px =
      std::clamp(2 * curve.radius_m * frame.intrinsics.fx / p.z(), kLeastWidth_px, kMostWidth_px);
  const float length = step.norm();
  station.slope = length > 0 ? step.dot(p.normalized()) / length : 0;
  return station;
}

/// Beyond the end `from`, away from `inner`.
Station beyond(const Station& from, const Station& inner, float widths) {
  Station station = from;
  const Vector2f outward = from.px - inner.px;
  const float length = outward.norm();
  if (length > kLeastChord_px) station.px += widths * from.width_px / length * outward;
  return station;
}

std::vector<Station> stations_of(const Curve& curve, const Frame& frame) {
  std::vector<Station> stations;
  for (int j = 2; j < kStations - 2; ++j) {
    stations.push_back(station_at(curve, (static_cast<float>(j) - 1.5F) / kStationsOfNode, frame));
  }
  const Station first = station_at(curve, 0, frame);
  const Station last = station_at(curve, kNodes - 1, frame);
  const std::array before{beyond(first, stations.front(), kBeyond[1]),
                          beyond(first, stations.front(), kBeyond[0])};
  const std::array after{beyond(last, stations.back(), kBeyond[0]),
                         beyond(last, stations.back(), kBeyond[1])};
  stations.insert(stations.begin(), before.begin(), before.end());
  stations.insert(stations.end(), after.begin(), after.end());
  for (std::size_t j = 0; j < stations.size(); ++j) {
    const Vector2f chord =
        stations[std::min(j + 1, stations.size() - 1)].px - stations[j > 0 ? j - 1 : 0].px;
    if (chord.norm() > kLeastChord_px) {
      stations[j].along = chord.normalized();
    } else if (j > 0) {
      stations[j].along = stations[j - 1].along;
    }
  }
  return stations;
}

/// Of a length in metres beside an ordinary one.
float log_of(float value, float ordinary) { return std::log(std::max(value, 1e-5F) / ordinary); }

void put_across(const Station& station, const Frame& frame, float radius_m, std::span<float> row) {
  const Vector2f across(-station.along.y(), station.along.x());
  const auto at = [&](int plane, int k) -> float& {
    return row[static_cast<std::size_t>(plane * kAcross + k)];
  };
  for (int k = 0; k < kAcross; ++k) {
    const float widths = (static_cast<float>(k) - 0.5F * (kAcross - 1)) * kAcrossSpacing;
    const Vector2f p = station.px + widths * station.width_px * across;
    const int u = geometry::nearest_px(p.x());
    const int v = geometry::nearest_px(p.y());
    if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) continue;
    const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                              static_cast<std::size_t>(u);
    const bool masked = frame.mask[pixel] > 127;
    if (masked) at(kMasked, k) = 1;
    const float depth_m = frame.depth_m[pixel];
    if (!geometry::measured(depth_m)) continue;
    at(kMeasured, k) = 1;
    at(masked ? kDepthOnMask : kDepthBeside, k) =
        std::clamp((depth_m - station.depth_m) / radius_m, -4.0F, 4.0F) + 1;
  }
}

using Frames = std::array<std::optional<LocalFrame>, kNodes>;

/// Where a node lies beside the table.
struct BesideTable {
  float share = 1;     ///< share_to()
  float way_m = 0;     ///< to it, deep
  float misfit_m = 0;  ///< of the table there
};

/// Nothing where the table is seen too flatly beside most nodes.
std::optional<std::array<BesideTable, kNodes>> beside_table(const Curve& curve,
                                                            const Frames& frames,
                                                            const Table& table) {
  std::array<BesideTable, kNodes> result;
  std::size_t known = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Vector3f node = geometry::to_eigen(curve.nodes[i]);
    if (!frames[i]) continue;
    const auto share = share_to(table, node, curve.radius_m);
    if (!share || !std::isfinite(*share)) continue;
    result[i] = {*share, (*share - 1) * node.dot(frames[i]->deep),
                 node.z() * node.z() * table.misfit};
    ++known;
  }
  if (2 * known < kNodes) return std::nullopt;
  return result;
}

/// How nodes with support lie beside the table, in its misfits.
struct Lie {
  float seen = 0;  ///< share of nodes that have support
  float near = 0;  ///< share of those that are near the table; 0 of too few, as what follows
  float median = 0;
  float spread = 0;
};

Lie lie_of(const Curve& curve, const std::array<BesideTable, kNodes>& beside) {
  std::vector<float> offs;
  float near = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (curve.unseen_m[i] > 0 || beside[i].misfit_m <= 0) continue;
    offs.push_back(beside[i].way_m / beside[i].misfit_m);
    const float reach_m = std::max(kNearTable * beside[i].misfit_m, curve.radius_m);
    near += std::abs(beside[i].way_m) < reach_m ? 1.0F : 0.0F;
  }
  Lie lie;
  lie.seen = static_cast<float>(offs.size()) / kNodes;
  if (offs.size() < kLeastSeen) return lie;
  lie.near = near / static_cast<float>(offs.size());
  lie.median = geometry::median_of(offs);
  for (float& off : offs) off = std::abs(off - lie.median);
  lie.spread = 1.4826F * geometry::median_of(offs);
  return lie;
}

/// Fills kTable and what follows of each node's `columns`, [kNodes, kColumnsUsed - kSigma].
void put_table(const Curve& curve, const Frames& frames, const Table& table, Strip& strip,
               std::span<float> columns) {
  const auto beside = beside_table(curve, frames, table);
  if (!beside) return;
  const Lie lie = lie_of(curve, *beside);
  constexpr std::size_t kCount = kColumnsUsed - kSigma;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const BesideTable& here = (*beside)[i];
    if (here.misfit_m <= 0) continue;
    const float way = here.way_m / curve.radius_m;
    const float off = here.way_m / here.misfit_m;
    if (lie.near >= kLies) strip.table_share[i] = here.share;
    const auto at = [&](Column column) -> float& {
      return columns[i * kCount + static_cast<std::size_t>(column - kSigma)];
    };
    at(kTable) = std::clamp(std::asinh(way) / 2, -2.0F, 2.0F);
    at(kTableOff) = std::clamp(off, -kMostOff, kMostOff) / 3;
    at(kTableMisfit) = std::clamp(std::log(here.misfit_m / curve.radius_m) / 2, -2.0F, 2.0F);
    at(kTableDepths) = std::clamp(log_of(table.misfit, 5e-3F) / 2, -2.0F, 2.0F);
    at(kTableRough) = std::clamp(table.roughness / table.misfit, 0.0F, 2.0F);
    at(kTableKnown) = table.known;
    at(kTableSeen) = lie.seen;
    at(kTableNear) = lie.near;
    at(kTableMedian) = std::clamp(lie.median, -kMostOff, kMostOff) / 3;
    at(kTableSpread) = std::clamp(lie.spread, 0.0F, kMostOff) / 3;
  }
}

/// [kNodes, kColumnsUsed - kSigma]
std::vector<float> node_columns(const Curve& curve, const Frames& frames, const Frame& frame) {
  constexpr std::size_t kCount = kColumnsUsed - kSigma;
  std::vector<float> columns(kNodes * kCount);
  const float length_m = std::max(geometry::length(curve.nodes), 1e-3F);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto at = [&](Column column) -> float& {
      return columns[i * kCount + static_cast<std::size_t>(column - kSigma)];
    };
    const float z = curve.nodes[i].z;
    const auto from_end = static_cast<float>(std::min(i, kNodes - 1 - i));
    at(kSigma) = std::clamp(log_of(curve.sigma_m[i], 3e-3F) / 3, -2.0F, 2.0F);
    at(kUnseen) = std::clamp(curve.unseen_m[i] / (20 * curve.radius_m), 0.0F, 1.0F);
    at(kUnsupported) = curve.unseen_m[i] > 0 ? 1.0F : 0.0F;
    at(kFromMiddle) = 1 - 2 * from_end / (kNodes - 1);
    at(kNearEnd) = std::exp(-from_end / 3);
    at(kPixel) = std::clamp(log_of(curve.pixel_m, 1e-3F) / 2, -2.0F, 2.0F);
    at(kNoise) = std::clamp(log_of(curve.noise_m + 1e-4F, 1e-3F) / 2, -2.0F, 2.0F);
    at(kLength) = std::clamp(log_of(length_m, 1) / 2, -3.0F, 3.0F);
    at(kRadius) = std::clamp(log_of(curve.radius_m, 5e-3F), -3.0F, 3.0F);
    at(kWidth) =
        std::clamp(log_of(2 * curve.radius_m * frame.intrinsics.fx / z, 10) / 2, -3.0F, 3.0F);
    at(kDistance) = std::clamp(log_of(z, 1), -3.0F, 3.0F);
    at(kThickness) = std::clamp(32 * curve.radius_m / length_m, 0.0F, 3.0F);
    if (i == 0 || i + 1 == kNodes || !frames[i]) continue;
    const Vector3f bend =
        (geometry::to_eigen(curve.nodes[i + 1]) + geometry::to_eigen(curve.nodes[i - 1]) -
         2 * geometry::to_eigen(curve.nodes[i])) /
        curve.radius_m;
    at(kBendDeep) = std::clamp(bend.dot(frames[i]->deep), -3.0F, 3.0F);
    at(kBendAlong) = std::clamp(bend.dot(frames[i]->along), -3.0F, 3.0F);
    at(kBendAside) = std::clamp(bend.dot(frames[i]->aside), -3.0F, 3.0F);
  }
  return columns;
}

}  // namespace

bool can_be_seen(const Curve& curve) {
  const bool in_front = std::all_of(curve.nodes.begin(), curve.nodes.end(), [](const Point3& node) {
    return node.z > geometry::kLeastDepth_m && node.z < geometry::kMostDepth_m;
  });
  return in_front && geometry::all_finite(curve.nodes) &&
         curve.radius_m > geometry::kLeastDepth_m && curve.radius_m < 1;
}

std::optional<Strip> strip_along(const Curve& curve, const Frame& frame) {
  if (!can_be_seen(curve)) return std::nullopt;
  const auto stations = stations_of(curve, frame);
  const Frames frames = local_frames(curve.nodes);
  auto of_nodes = node_columns(curve, frames, frame);
  constexpr std::size_t kOfNode = kColumnsUsed - kSigma;
  Strip strip;
  std::vector<AxisPlace> places;
  for (const Station& s : stations) places.push_back({s.px, s.along, 0.5F * s.width_px});
  std::vector<Beside> beside(stations.size());
  const auto table = table_beside(places, frame, beside);
  if (table) put_table(curve, frames, *table, strip, of_nodes);
  strip.values.assign(static_cast<std::size_t>(kStations) * weights::kRefineInputs, 0.0F);
  for (std::size_t j = 0; j < stations.size(); ++j) {
    const Station& s = stations[j];
    const auto row =
        std::span(strip.values).subspan(j * weights::kRefineInputs, weights::kRefineInputs);
    put_across(s, frame, curve.radius_m, row);
    if (j > 0 && j + 1 < stations.size()) {
      const Vector2f& before = stations[j - 1].along;
      const Vector2f& after = stations[j + 1].along;
      const float turn =
          std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
      row[kTurn] = std::clamp(turn, -1.0F, 1.0F);
      const float step = (stations[j + 1].px - stations[j - 1].px).norm();
      row[kStep] = std::clamp(std::log2(std::max(1e-3F, step / s.width_px)) / 4, -1.0F, 1.0F);
    }
    row[kSlope] = s.slope;
    if (beside[j].sides > 0) {
      row[kGround] = std::asinh((beside[j].depth_m - s.depth_m) / curve.radius_m) / 2;
      row[kGroundSides] = 0.5F * static_cast<float>(beside[j].sides);
    }
    row[kInside] = s.px.x() >= 0 && s.px.y() >= 0 && s.px.x() < static_cast<float>(frame.width) &&
                           s.px.y() < static_cast<float>(frame.height)
                       ? 1.0F
                       : 0.0F;
    const std::size_t node = j / kStationsOfNode;
    std::copy_n(of_nodes.begin() + static_cast<std::ptrdiff_t>(node * kOfNode), kOfNode,
                row.begin() + kSigma);
  }
  return strip;
}

}  // namespace flowdlo::refine
