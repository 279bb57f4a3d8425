#include "path/hidden_forks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kArmWidths = 1.5F;  // a turn is measured between arms of this length
constexpr float kLeastArmPx = 6.0F;
constexpr float kShortestArm = 0.7F;  // next to an end, a share of it will do
constexpr float kLeastTurn = 0.7F;    // rad
constexpr float kReachWidths = 2.0F;  // from the turn to the occluder

struct Turn {
  float angle = 0;
  Vector2f outside{0, 0};
};

Turn turn_at(const Points& points, int i, int arm, bool ring) {
  const int count = static_cast<int>(points.size());
  const auto point = [&](int k) -> const Vector2f& {
    return points[ring ? (k + count) % count : std::clamp(k, 0, count - 1)];
  };
  const Vector2f in = (point(i) - point(i - arm)).normalized();
  const Vector2f out = (point(i + arm) - point(i)).normalized();
  if (!in.allFinite() || !out.allFinite()) return {};
  const Vector2f outside = in - out;
  if (outside.norm() <= 0) return {};
  return {std::acos(std::clamp(in.dot(out), -1.0F, 1.0F)), outside.normalized()};
}

// Where the segment turns most, arm by arm, with an occluder outside.
std::vector<int> turns(const Points& points, bool ring, const Cover& cover, float scale_px) {
  const int count = static_cast<int>(points.size());
  const int arm = static_cast<int>(std::max(kLeastArmPx, kArmWidths * scale_px));
  const int margin = ring ? 0 : static_cast<int>(kShortestArm * static_cast<float>(arm));
  if (count < 2 * std::max(margin, arm / 2)) return {};
  std::vector<Turn> all(points.size());
  for (int i = margin; i < count - margin; ++i) all[i] = turn_at(points, i, arm, ring);
  std::vector<int> result;
  for (int i = margin; i < count - margin; ++i) {
    if (all[i].angle < kLeastTurn) continue;
    bool most = true;
    for (int k = std::max(0, i - arm); most && k <= std::min(count - 1, i + arm); ++k) {
      most = all[k].angle < all[i].angle || (all[k].angle == all[i].angle && k >= i);
    }
    if (!most) continue;
    const float reach = kReachWidths * scale_px;
    const float rope_m = cover.rope_depth(points[i]);
    if (cover.beyond(points[i], all[i].outside, rope_m, reach) == Sight::kHidden) {
      result.push_back(i);
    }
  }
  return result;
}

int add_node(Graph& graph, const Vector2f& position) {
  graph.nodes.push_back({position, 0.5F * graph.width_px, {}});
  return static_cast<int>(graph.nodes.size()) - 1;
}

// The segment becomes one that ends at point `at`, and a new one takes the rest.
void split(Graph& graph, int id, int at) {
  const int node = add_node(graph, graph.segments[id].points_px[at]);
  const auto rest_id = static_cast<int>(graph.segments.size());
  Segment rest;
  Segment& kept = graph.segments[id];
  rest.points_px.assign(kept.points_px.begin() + at, kept.points_px.end());
  kept.points_px.resize(static_cast<std::size_t>(at) + 1);
  rest.node = {node, kept.node[1]};
  kept.node[1] = node;
  rest.length_px = length_of(rest.points_px);
  kept.length_px = length_of(kept.points_px);
  auto& far = graph.nodes[rest.node[1]].ends;
  std::replace(far.begin(), far.end(), 2 * id + 1, 2 * rest_id + 1);
  graph.nodes[node].ends = {2 * id + 1, 2 * rest_id};
  graph.segments.push_back(std::move(rest));
}

// The ring is cut at point `at`: both its ends meet there.
void open_ring(Graph& graph, int id, int at) {
  Segment& ring = graph.segments[id];
  std::rotate(ring.points_px.begin(), ring.points_px.begin() + at, ring.points_px.end());
  ring.points_px.push_back(ring.points_px.front());
  const int node = add_node(graph, ring.points_px.front());
  ring.node = {node, node};
  graph.nodes[node].ends = {2 * id, 2 * id + 1};
}

}  // namespace

void split_at_hidden_forks(Graph& graph, const Cover& cover) {
  const float scale_px = std::max(4.0F, graph.width_px);
  const auto count = static_cast<int>(graph.segments.size());
  for (int id = 0; id < count; ++id) {
    if (!graph.segments[id].alive) continue;
    const bool ring = graph.segments[id].ring();
    std::vector<int> at = turns(graph.segments[id].points_px, ring, cover, scale_px);
    if (at.empty()) continue;
    if (ring) {
      const int first = at.front();
      open_ring(graph, id, first);
      at.erase(at.begin());
      for (int& i : at) i -= first;
    }
    for (auto it = at.rbegin(); it != at.rend(); ++it) split(graph, id, *it);
  }
}

}  // namespace flowdlo::path
