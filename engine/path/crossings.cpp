#include "path/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kKnotWidths = 1.0F;    // junctions this near are one crossing
constexpr float kBridgeWidths = 8.0F;  // longest stretch that two strands share
constexpr float kDoubleWidths = 1.2F;  // a longer one is wider than this
constexpr float kStemCosine = -0.35F;  // a fork's branches leave its stem forwards
constexpr float kStemReachWidths = 1.5F;

// The direction in which the branch with this end leaves its node.
Vector2f leaving(const Graph& graph, int end, float reach_px) {
  const std::vector<Vector2f>& points = graph.segments[end / 2].points_px;
  const auto last = points.size() - 1;
  const std::size_t steps = std::min<std::size_t>(static_cast<std::size_t>(reach_px), last);
  const Vector2f d = end % 2 == 0 ? Vector2f(points[steps] - points[0])
                                  : Vector2f(points[last - steps] - points[last]);
  const float norm = d.norm();
  return norm > 0 ? Vector2f(d / norm) : Vector2f(0, 0);
}

// True when the other branches at this end's node all leave opposite to the segment: two strands
// run into one.
bool stem(const Graph& graph, int end, float reach_px) {
  const Node& node = graph.nodes[graph.segments[end / 2].node[end % 2]];
  if (node.ends.size() != 3) return false;
  const Vector2f along = leaving(graph, end, reach_px);
  for (const int other : node.ends) {
    if (other != end && leaving(graph, other, reach_px).dot(along) > kStemCosine) return false;
  }
  return true;
}

float width_of(const Segment& segment, const image::Image<float>& distance) {
  std::vector<float> values;
  for (const Vector2f& p : segment.points_px) {
    values.push_back(
        width_at(distance.at(geometry::nearest_px(p.y()), geometry::nearest_px(p.x()))));
  }
  if (values.empty()) return 0;
  return geometry::median_of(values);
}

// True for a knot of junctions, and where two strands lie on or beside each other.
bool shared(const Graph& graph, int id, const image::Image<float>& distance, float scale_px) {
  const Segment& segment = graph.segments[id];
  if (!segment.alive || segment.ring() || segment.node[0] == segment.node[1]) return false;
  if (graph.nodes[segment.node[0]].ends.size() < 3) return false;
  if (graph.nodes[segment.node[1]].ends.size() < 3) return false;
  if (segment.length_px <= kKnotWidths * scale_px) return true;
  const float reach = kStemReachWidths * scale_px;
  if (!stem(graph, 2 * id, reach) || !stem(graph, 2 * id + 1, reach)) return false;
  return segment.length_px <= kBridgeWidths * scale_px ||
         width_of(segment, distance) >= kDoubleWidths * graph.width_px;
}

}  // namespace

Crossings::Crossings(const Graph& graph, const image::Image<float>& distance_px, float scale_px)
    : crossing_(graph.nodes.size()), inner_(graph.segments.size(), false) {
  std::iota(crossing_.begin(), crossing_.end(), 0);
  const auto root = [&](int node) {
    while (crossing_[node] != node) node = crossing_[node] = crossing_[crossing_[node]];
    return node;
  };
  for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
    if (!shared(graph, i, distance_px, scale_px)) continue;
    inner_[i] = true;
    crossing_[root(graph.segments[i].node[0])] = root(graph.segments[i].node[1]);
  }
  for (int node = 0; node < static_cast<int>(crossing_.size()); ++node)
    crossing_[node] = root(node);
}

}  // namespace flowdlo::path
