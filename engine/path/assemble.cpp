#include "path/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "geometry/pixel.hpp"
#include "image/components.hpp"
#include "path/cover.hpp"
#include "path/links.hpp"
#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kShortestAxisPx = 4.0F;

struct Drawn {
  Points points;
  std::vector<std::uint8_t> bridged;

  void add(const Vector2f& p, bool gap) {
    points.push_back(p);
    bridged.push_back(gap ? 1 : 0);
  }
};

bool inside(const Points& points, const image::Mask& mask) {
  return std::all_of(points.begin(), points.end(), [&](const Vector2f& p) { return lit(mask, p); });
}

// Bridges from node to node inside a crossing, shortest way; empty when they do not connect.
std::vector<int> bridges_between(const Strands& strands, int from, int to) {
  std::multimap<int, int> leaving;  // node to the ends of bridges there, 2 * bridge + side
  for (int end = 0; end < 2 * static_cast<int>(strands.bridges.size()); ++end) {
    leaving.emplace(strands.bridges[end / 2].node[end % 2], end);
  }
  std::vector<std::pair<int, int>> came;  // (node, bridge end that led there)
  std::vector<int> parent;
  std::set<int> seen{from};
  came.emplace_back(from, -1);
  parent.push_back(-1);
  for (std::size_t i = 0; i < came.size(); ++i) {
    if (came[i].first == to) {
      std::vector<int> way;
      for (auto at = static_cast<int>(i); parent[at] >= 0; at = parent[at]) {
        way.push_back(came[at].second);
      }
      std::reverse(way.begin(), way.end());
      return way;
    }
    const auto [first, last] = leaving.equal_range(came[i].first);
    for (auto end = first; end != last; ++end) {
      const int next = strands.bridges[end->second / 2].node[1 - end->second % 2];
      if (!seen.insert(next).second) continue;
      came.emplace_back(next, end->second);
      parent.push_back(static_cast<int>(i));
    }
  }
  return {};
}

// The skeleton's way through a crossing. Where the mask is wider than the rope the strands lie
// side by side: each keeps to its side, and changes over where it leaves on the other.
Points along_bridges(const Strands& strands, const image::Image<float>& distance,
                     const std::vector<int>& way, const StrandEnd& from, const StrandEnd& to) {
  Points middle;
  for (const int end : way) {
    Points points = strands.bridges[end / 2].points_px;
    if (end % 2 == 1) std::reverse(points.begin(), points.end());
    middle.insert(middle.end(), points.begin(), points.end());
  }
  const int count = static_cast<int>(middle.size());
  const int reach = std::max(1, static_cast<int>(strands.scale_px));
  const auto normal = [&](int i) {
    const Vector2f d = middle[std::min(i + reach, count - 1)] - middle[std::max(i - reach, 0)];
    return d.norm() > 0 ? Vector2f(Vector2f(-d.y(), d.x()).normalized()) : Vector2f(0, 0);
  };
  const float enters = normal(0).dot(from.point_px - from.fork_px) >= 0 ? 1.0F : -1.0F;
  const float leaves = normal(count - 1).dot(to.point_px - to.fork_px) >= 0 ? 1.0F : -1.0F;
  Points points;
  const int margin = count > 4 * reach ? reach : 0;  // next to the forks the cubic is smoother
  for (int i = margin; i < count - margin; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count);
    const auto u = geometry::nearest_px(middle[i].x());
    const auto v = geometry::nearest_px(middle[i].y());
    const float wide = width_at(distance.at(v, u)) - strands.width_px;
    const float aside = 0.5F * std::clamp(wide, 0.0F, strands.width_px);
    points.push_back(middle[i] + ((1 - t) * enters + t * leaves) * aside * normal(i));
  }
  return points;
}

// Through a crossing the link's curve is the better guess (the skeleton there is pulled to the
// middle), as long as it stays in the mask; otherwise the skeleton is followed.
void draw_bond(const Strands& strands, const Region& region, const Cover& cover, int from_id,
               int to_id, Drawn& drawn) {
  const StrandEnd& from = strands.end(from_id);
  const StrandEnd& to = strands.end(to_id);
  const bool gap = from.tip() || to.tip() || from.crossing != to.crossing;
  Points points = points_between(from_id, to_id, strands, cover);
  if (!gap && from.node != to.node && !inside(points, region.mask)) {
    const std::vector<int> way = bridges_between(strands, from.node, to.node);
    if (!way.empty()) points = along_bridges(strands, region.distance_px, way, from, to);
  }
  for (const Vector2f& p : points) drawn.add(p, gap);
}

// About one pixel apart; the ends stay, points nearer than a tenth of a pixel are dropped.
Drawn resampled(const Drawn& drawn) {
  Drawn result;
  if (drawn.points.empty()) return result;
  double walked = 0;
  double total = 0;
  for (std::size_t i = 1; i < drawn.points.size(); ++i) {
    total += (drawn.points[i] - drawn.points[i - 1]).norm();
  }
  const int steps = std::max(1, static_cast<int>(std::lround(total)));
  const double step = total / steps;
  result.add(drawn.points.front(), drawn.bridged.front() != 0);
  int next = 1;
  for (std::size_t i = 1; i < drawn.points.size() && next < steps; ++i) {
    const Vector2f a = drawn.points[i - 1];
    const Vector2f d = drawn.points[i] - a;
    const double length = d.norm();
    while (next < steps && walked + length >= next * step) {
      const double t = length > 0 ? (next * step - walked) / length : 0;
      result.add(a + static_cast<float>(t) * d, drawn.bridged[i] != 0);
      ++next;
    }
    walked += length;
  }
  if (total > 0.1) result.add(drawn.points.back(), drawn.bridged.back() != 0);
  return result;
}

Path to_image(const Drawn& drawn, const Region& region, const Frame& frame) {
  Path path;
  for (std::size_t i = 0; i < drawn.points.size(); ++i) {
    Vector2f p = drawn.points[i];
    p.x() = std::clamp(p.x() + static_cast<float>(region.offset_px.x), 0.0F,
                       static_cast<float>(frame.width - 1));
    p.y() = std::clamp(p.y() + static_cast<float>(region.offset_px.y), 0.0F,
                       static_cast<float>(frame.height - 1));
    if (!p.allFinite()) continue;
    if (!path.points_px.empty() && path.points_px.back() == p) continue;
    path.points_px.push_back(p);
    path.bridged.push_back(drawn.bridged[i]);
  }
  return path;
}

}  // namespace

Path assemble(const Traversal& traversal, const Strands& strands, const Region& region,
              const Frame& frame) {
  const Cover cover(region, frame, strands.width_px, strands.seen);
  Drawn drawn;
  const StrandEnd& first = strands.end(traversal.enters.front());
  const StrandEnd& last = strands.end(traversal.enters.back() ^ 1);
  for (std::size_t i = 0; i < traversal.enters.size(); ++i) {
    const int enter = traversal.enters[i];
    if (i > 0) {
      draw_bond(strands, region, cover, traversal.enters[i - 1] ^ 1, enter, drawn);
    }
    Points points = strands.list[enter / 2].points_px;
    if (enter % 2 == 1) std::reverse(points.begin(), points.end());
    for (const Vector2f& p : points) drawn.add(p, false);
  }
  if (traversal.closed && traversal.enters.size() > 0 &&
      !strands.list[traversal.enters.front() / 2].ring) {
    draw_bond(strands, region, cover, traversal.enters.back() ^ 1, traversal.enters.front(), drawn);
  }
  drawn = resampled(drawn);
  const int half = std::clamp(static_cast<int>(std::lround(0.2F * strands.width_px)), 1, 5);
  drawn.points = smoothed(std::move(drawn.points), half);
  Path path = to_image(resampled(drawn), region, frame);
  path.score = -static_cast<double>(traversal.cost);
  const Strand& one = strands.list[traversal.enters.front() / 2];
  path.ring = one.ring || traversal.closed;
  path.closed = path.ring;
  if (traversal.closed) return path;
  for (const StrandEnd* end : {&first, &last}) {
    path.hidden_ends += end->tip() && end->cut ? 0.5F : 0;
    path.buried_ends += end->tip() ? 0 : 0.5F;
  }
  return path;
}

// Of the pixels with that label: their middle, and the direction in which they spread most.
std::pair<Vector2f, Vector2f> middle_and_axis(const image::Image<int>& labels, int label) {
  std::int64_t count = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t xx = 0;
  std::int64_t xy = 0;
  std::int64_t yy = 0;
  for (int v = 0; v < labels.height(); ++v) {
    for (int u = 0; u < labels.width(); ++u) {
      if (labels.at(v, u) != label) continue;
      ++count;
      x += u;
      y += v;
      xx += std::int64_t{u} * u;
      xy += std::int64_t{u} * v;
      yy += std::int64_t{v} * v;
    }
  }
  const auto number = [](std::int64_t value) { return static_cast<double>(value); };
  const double middle_x = number(x) / number(count);
  const double middle_y = number(y) / number(count);
  const double spread_xy = number(xy) - number(x) * middle_y;
  const double spread_xx = number(xx) - number(x) * middle_x;
  const double spread_yy = number(yy) - number(y) * middle_y;
  const double tilt = 0.5 * std::atan2(2 * spread_xy, spread_xx - spread_yy);
  return {{static_cast<float>(middle_x), static_cast<float>(middle_y)},
          {static_cast<float>(std::cos(tilt)), static_cast<float>(std::sin(tilt))}};
}

Path long_axis(const Region& region, const Frame& frame) {
  const auto [labels, pieces] = image::components(region.mask, image::Neighbours::kEight);
  int largest = 0;
  int most = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    if (pieces[i].area <= most) continue;
    largest = static_cast<int>(i);
    most = pieces[i].area;
  }
  if (largest == 0) return {};
  const auto [middle, axis] = middle_and_axis(labels, largest);
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  for (int v = 0; v < labels.height(); ++v) {
    for (int u = 0; u < labels.width(); ++u) {
      if (labels.at(v, u) != largest) continue;
      const float along = axis.dot(Vector2f(static_cast<float>(u), static_cast<float>(v)) - middle);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  if (high - low < kShortestAxisPx) return {};
  Drawn drawn;
  drawn.add(middle + low * axis, false);
  drawn.add(middle + high * axis, false);
  return to_image(resampled(drawn), region, frame);
}

}  // namespace flowdlo::path
