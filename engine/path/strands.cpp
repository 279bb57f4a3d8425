#include "path/strands.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"
#include "path/cover.hpp"
#include "path/crossings.hpp"
#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kFullShare = 0.85F;   // of the usual half width: a tip begins below
constexpr float kTipWidths = 5.0F;    // the stretch that tells what is usual
constexpr float kDepthWidths = 3.0F;  // length over which a depth is fitted
constexpr int kDepthSamples = 16;
constexpr float kSlopeWidths = 2.0F;     // a slope over this length counts half
constexpr float kCutWidths = 3.0F;       // how far ahead an occluder is looked for
constexpr float kHeadingWidths = 0.75F;  // from the middle of what tells the direction to the end
constexpr float kMaxSlope = 1.5F;        // metres of depth a metre sideways
constexpr float kLeastMasked = 0.3F;     // share of a stretch that the mask knows too

float at(const image::Image<float>& image, const Vector2f& p) {
  const int u = std::clamp(geometry::nearest_px(p.x()), 0, image.width() - 1);
  const int v = std::clamp(geometry::nearest_px(p.y()), 0, image.height() - 1);
  return image.at(v, u);
}

// How many points at side 0 the crossing distorts: there the mask is wider than the rope.
int distorted(const Points& points, const image::Image<float>& distance, float scale_px,
              float width_px) {
  const int count = static_cast<int>(points.size());
  const int most = static_cast<int>(std::min(0.4F * static_cast<float>(count), 3.0F * scale_px));
  const float calm = 0.5F * 1.15F * width_px + 0.75F;
  for (int i = 0; i < most; ++i) {
    if ((points[i] - points[0]).norm() < 0.5F * scale_px) continue;
    if (at(distance, points[i]) <= calm) return i;
  }
  return most;
}

// Cuts what is skewed at a tip: half a width, and all of the corner where an occluder cut the rope
// aslant.
void trim_tip(Points& points, const Region& region, float width_px, float scale_px) {
  std::vector<float> distances;
  const auto near = std::min(points.size(), static_cast<std::size_t>(kTipWidths * scale_px));
  for (std::size_t i = 0; i < near; ++i) distances.push_back(at(region.distance_px, points[i]));
  const float full = kFullShare * geometry::median_of(distances);
  const auto most = std::min(points.size() / 3, static_cast<std::size_t>(2.5F * width_px));
  std::size_t cut = 0;
  while (cut < most && ((points[cut] - points[0]).norm() < 0.5F * width_px ||
                        at(region.distance_px, points[cut]) < full)) {
    ++cut;
  }
  points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(cut));
}

// Follows the direction of a trimmed tip to the mask's edge.
void extend_tip(Points& points, const Region& region, float width_px, float scale_px) {
  const Vector2f out = direction_at_front(points, scale_px);
  const Vector2f start = points.front();
  Points added;
  const int reach = static_cast<int>(3.0F * width_px + 4.0F);
  for (int step = 1; step <= reach; ++step) {
    const Vector2f p = start + out * static_cast<float>(step);
    if (at(region.distance_px, p) <= 0) break;
    added.push_back(p);
  }
  points.insert(points.begin(), added.rbegin(), added.rend());
}

// Median of the valid depths of the mask in the five pixels around `p`; 0 without any.
float depth_at(const Vector2f& p, const Region& region, const Frame& frame) {
  std::vector<float> values;
  for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int u = geometry::nearest_px(p.x()) + du;
    const int v = geometry::nearest_px(p.y()) + dv;
    if (u < 0 || v < 0 || u >= region.mask.width() || v >= region.mask.height()) continue;
    if (region.mask.at(v, u) == 0) continue;
    const int image_u = u + region.offset_px.x;
    const int image_v = v + region.offset_px.y;
    if (image_u < 0 || image_v < 0 || image_u >= frame.width || image_v >= frame.height) continue;
    const float z = frame.depth_m[static_cast<std::size_t>(image_v) * frame.width + image_u];
    if (geometry::measured(z)) values.push_back(z);
  }
  return values.empty() ? 0 : geometry::median_of(values);
}

// Of a point that lies under an occluder: the depth of what shows beside it.
float depth_beside(const Points& points, int i, const Region& region, const Frame& frame,
                   float scale_px) {
  const int last = static_cast<int>(points.size()) - 1;
  const Vector2f along = points[std::min(i + 2, last)] - points[std::max(i - 2, 0)];
  if (along.norm() <= 0) return 0;
  const Vector2f normal = Vector2f(-along.y(), along.x()).normalized();
  for (const float off : {0.2F, -0.2F, 0.35F, -0.35F}) {
    const float z = depth_at(points[i] + off * scale_px * normal, region, frame);
    if (z > 0) return z;
  }
  return 0;
}

// Depth at the front of `points` and its slope: the median of slopes between samples, and the
// median of what they foretell (Theil and Sen). Next to a crossing the other strand bleeds into
// the depth: nothing is taken there while enough is left.
void measure_depth(const Points& points, const Region& region, const Frame& frame, float scale_px,
                   StrandEnd& end) {
  const int count = static_cast<int>(points.size());
  const int skipped = end.tip() ? std::min(static_cast<int>(0.7F * scale_px), count / 4)
                                : std::min(static_cast<int>(scale_px), count / 2);
  const int window = static_cast<int>(std::max(kDepthWidths * scale_px, 12.0F));
  const int last = std::min(count, skipped + window);
  const int step = std::max(1, (last - skipped) / kDepthSamples);
  std::vector<std::pair<float, float>> samples;  // how far from the front, depth
  for (int i = skipped; i < last; i += step) {
    float z = depth_at(points[i], region, frame);
    if (z <= 0) z = depth_beside(points, i, region, frame, scale_px);
    if (z > 0) samples.emplace_back(static_cast<float>(i), z);
  }
  if (samples.size() < 3) return;
  // Depths come in steps: only samples far from each other tell a slope.
  std::vector<float> values;
  for (std::size_t i = 0, j = samples.size() / 2; j < samples.size(); ++i, ++j) {
    values.push_back((samples[i].second - samples[j].second) /
                     (samples[j].first - samples[i].first));
  }
  const float limit = kMaxSlope * samples.front().second / std::max(1.0F, frame.intrinsics.fx);
  const float span = static_cast<float>(last - skipped);
  const float trust = span / (span + kSlopeWidths * scale_px);
  const float slope = trust * std::clamp(geometry::median_of(values), -limit, limit);
  values.clear();
  for (const auto& [from, z] : samples) values.push_back(z + slope * from);
  end.slope_per_px = slope;
  end.depth_m = geometry::median_of(values);
}

// Whether the rope may leave the image at `p`.
bool at_border(const Vector2f& p, const Region& region, const Frame& frame, float width_px) {
  const float u = p.x() + static_cast<float>(region.offset_px.x);
  const float v = p.y() + static_cast<float>(region.offset_px.y);
  return std::min({u, v, static_cast<float>(frame.width - 1) - u,
                   static_cast<float>(frame.height - 1) - v}) < width_px;
}

// The end at the front of `points`: place, directions, depth, and what lies behind it.
void measure_end(const Points& points, const Region& region, const Frame& frame, const Cover& cover,
                 float scale_px, StrandEnd& end) {
  end.point_px = points.front();
  end.outward = direction_at_front(points, scale_px);
  end.curvature = curvature_at_front(points, scale_px);
  end.heading = Eigen::Rotation2Df(kHeadingWidths * scale_px * end.curvature) * end.outward;
  measure_depth(points, region, frame, scale_px, end);
  end.leaves = at_border(points.front(), region, frame, scale_px);
  end.cut =
      cover.beyond(end.point_px, end.outward, end.depth_m, kCutWidths * scale_px) == Sight::kHidden;
}

// How much an end of the mask's own strand looks like the rope's, as no field says it.
float plain_tip(const StrandEnd& end, const Cover& cover, float scale_px) {
  if (!end.tip()) return 0;
  const bool covered = end.cut || cover.meets(end.point_px, end.outward, kCutWidths * scale_px);
  return covered ? kCoveredTip : kPlainTip;
}

Strand make_strand(const Segment& segment, const Graph& graph, const Crossings& crossings,
                   const Region& region, const Frame& frame, const Strands& sizes) {
  const Cover cover(region, frame, sizes.width_px);
  Strand strand;
  strand.ring = segment.ring();
  strand.covers_px = segment.length_px;
  const int half = std::clamp(static_cast<int>(std::lround(0.3F * sizes.width_px)), 1, 8);
  Points points = smoothed(segment.points_px, half);
  recentre(points, region.mask, sizes.width_px);
  for (int side = 0; side < 2; ++side) {
    StrandEnd& end = strand.ends[side];
    end.node = segment.node[side];
    const bool tip = strand.ring || graph.at_tip(segment, side);
    end.crossing = tip ? -1 : crossings.of(end.node);
    if (!strand.ring && !tip) {
      const int cut = distorted(points, region.distance_px, sizes.scale_px, sizes.width_px);
      points.erase(points.begin(), points.begin() + cut);
      if (graph.at_tip(segment, 1 - side)) strand.covers_px -= graph.nodes[end.node].distance_px;
    } else if (!strand.ring) {
      trim_tip(points, region, sizes.width_px, sizes.scale_px);
      extend_tip(points, region, sizes.width_px, sizes.scale_px);
    }
    measure_end(points, region, frame, cover, sizes.scale_px, end);
    end.tip_seen = plain_tip(end, cover, sizes.scale_px);
    end.look = look_of(points, sizes.scale_px, region, frame, {});
    std::reverse(points.begin(), points.end());
  }
  strand.covers_px = std::max(0.0F, strand.covers_px);
  strand.points_px = std::move(points);
  return strand;
}

// The ends that meet at a node lie left and right of their middle.
void find_forks(Strands& strands) {
  std::map<int, std::pair<Vector2f, int>> met;  // node to sum and count
  for (const Strand& strand : strands.list) {
    for (const StrandEnd& end : strand.ends) {
      auto& [sum, count] = met.try_emplace(end.node, Vector2f(0, 0), 0).first->second;
      sum += end.point_px;
      ++count;
    }
  }
  for (Strand& strand : strands.list) {
    for (StrandEnd& end : strand.ends) {
      const auto& [sum, count] = met.at(end.node);
      end.fork_px = sum / static_cast<float>(count);
    }
  }
}

}  // namespace

StopTerms stop_terms(const StrandEnd& end, float goes_on) {
  StopTerms terms{};
  terms[kStopStart] = 1;
  terms[kStopUnseen] = end.leaves ? 0 : 1 - end.tip_seen;
  terms[kStopHeard] = goes_on;
  return terms;
}

float width_px_of(const Strand& strand, const Strands& strands) {
  const float sum = strand.ends[0].look.width_px + strand.ends[1].look.width_px;
  const bool known = strand.ends[0].look.width_px > 0 && strand.ends[1].look.width_px > 0;
  return known ? std::max(kLeastScalePx, 0.5F * sum) : strands.scale_px;
}

float scale_between(const StrandEnd& a, const StrandEnd& b, const Strands& strands) {
  if (a.look.width_px <= 0 || b.look.width_px <= 0) return strands.scale_px;
  return std::max(kLeastScalePx, 0.5F * (a.look.width_px + b.look.width_px));
}

float left_out_energy(const Strand& strand, const Strands& strands) {
  return kLeftOutEnergy * strand.covers_px / width_px_of(strand, strands);
}

Strands make_strands(const std::vector<Stretch>& stretches, float width_px, const Region& region,
                     const Frame& frame, const field::FieldView& seen) {
  Strands strands;
  strands.width_px = width_px;
  strands.scale_px = std::max(kLeastScalePx, width_px);
  strands.seen = &seen;
  const Cover cover(region, frame, width_px);
  for (const Stretch& stretch : stretches) {
    Strand strand;
    Points points = stretch.points_px;
    const auto masked = std::count_if(points.begin(), points.end(),
                                      [&](const Vector2f& p) { return lit(region.mask, p); });
    strand.covers_px = static_cast<float>(masked);
    if (strand.covers_px < kLeastMasked * static_cast<float>(points.size())) continue;
    strand.ring = stretch.closed;
    for (int side = 0; side < 2; ++side) {
      StrandEnd& end = strand.ends[side];
      measure_end(points, region, frame, cover, strands.scale_px, end);
      if (end.cut && !strand.ring) {
        trim_tip(points, region, width_px, strands.scale_px);
        measure_end(points, region, frame, cover, strands.scale_px, end);
      }
      end.tip_seen = stretch.tips[side];
      end.look = look_of(points, strands.scale_px, region, frame, seen);
      std::reverse(points.begin(), points.end());
    }
    strand.points_px = std::move(points);
    strands.list.push_back(std::move(strand));
  }
  return strands;
}

Strands make_strands(const Graph& graph, const Region& region, const Frame& frame) {
  Strands strands;
  strands.width_px = graph.width_px;
  strands.scale_px = std::max(kLeastScalePx, graph.width_px);
  const int half = std::clamp(static_cast<int>(std::lround(0.5F * strands.width_px)), 1, 8);
  const Crossings crossings(graph, region.distance_px, strands.scale_px);
  for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
    const Segment& segment = graph.segments[i];
    if (!segment.alive || segment.points_px.size() < 2) continue;
    if (crossings.inner(i)) {
      strands.bridges.push_back({smoothed(segment.points_px, half), segment.node});
    } else {
      strands.list.push_back(make_strand(segment, graph, crossings, region, frame, strands));
    }
  }
  find_forks(strands);
  return strands;
}

}  // namespace flowdlo::path
