#include "path/graph.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/pixel.hpp"
#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kSpurPx = 2.5F;         // a branch that protrudes less is no part of the rope
constexpr float kStumpWidths = 0.3F;    // nor is one this short, even as thick as the rope,
constexpr float kWhiskerWidths = 1.6F;  // nor one this short
constexpr float kWhiskerShare = 0.55F;  // that is thinner than this share of the rope
constexpr float kThinPx = 6.0F;         // ropes whose thickness tells nothing:
constexpr float kSpurWidths = 0.5F;     // for them a branch this short
constexpr float kSingleShare = 1.5F;    // of the narrow parts' width: one strand up to this
constexpr int kPruningRounds = 24;

struct Step {
  int u;
  int v;
};
constexpr std::array<Step, 8> kAround{
    {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

image::Point operator+(const image::Point& p, const Step& d) { return {p.x + d.u, p.y + d.v}; }

Vector2f vec(image::Point p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// A ring is cut open where it is leftmost, then topmost.
void rotate_ring(std::vector<Vector2f>& points) {
  const auto first = std::min_element(points.begin(), points.end(), [](auto& a, auto& b) {
    return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
  });
  std::rotate(points.begin(), first, points.end());
}

// Reads pixels into nodes and segments.
class Tracer {
 public:
  Tracer(const image::Mask& thinned, const image::Image<float>& distance)
      : thinned_(thinned),
        distance_(distance),
        node_of_(thinned.size(), -1),
        degree_(thinned.size(), 0),
        seen_(thinned.size(), 0) {}

  Graph run() {
    collect();
    for (const image::Point& p : pixels_) {
      if (degree_.at(p) > 2 && node_of_.at(p) < 0) add_junction(p);
    }
    for (const image::Point& p : pixels_) {
      if (degree_.at(p) == 1) add_tip(p);
    }
    for (const image::Point& p : pixels_) start_chains(p);
    for (const image::Point& p : pixels_) {
      if (degree_.at(p) == 2 && seen_.at(p) == 0) add_ring(p);
    }
    return std::move(graph_);
  }

 private:
  void collect() {
    for (int v = 1; v + 1 < thinned_.height(); ++v) {
      const std::uint8_t* row = thinned_.row(v);
      for (int u = 1; u + 1 < thinned_.width(); ++u) {
        if (row[u] == 0) continue;
        const image::Point p{u, v};
        int degree = 0;
        for (const Step& d : kAround) degree += thinned_.at(p + d);
        degree_.at(p) = static_cast<std::uint8_t>(degree);
        pixels_.push_back(p);
      }
    }
  }

  void add_junction(image::Point seed) {
    const auto id = static_cast<int>(graph_.nodes.size());
    Node node;
    std::vector<image::Point> members{seed};
    node_of_.at(seed) = id;
    Vector2f sum{0, 0};
    for (std::size_t i = 0; i < members.size(); ++i) {
      const image::Point p = members[i];
      sum += vec(p);
      node.distance_px = std::max(node.distance_px, distance_.at(p));
      for (const Step& d : kAround) {
        const image::Point q = p + d;
        if (degree_.at(q) > 2 && node_of_.at(q) < 0) {
          node_of_.at(q) = id;
          members.push_back(q);
        }
      }
    }
    node.position_px = sum / static_cast<float>(members.size());
    graph_.nodes.push_back(std::move(node));
  }

  void add_tip(image::Point p) {
    node_of_.at(p) = static_cast<int>(graph_.nodes.size());
    graph_.nodes.push_back({vec(p), distance_.at(p), {}});
  }

  // Chains that leave the node at `p`.
  void start_chains(image::Point p) {
    const int node = node_of_.at(p);
    if (node < 0) return;
    for (const Step& d : kAround) {
      const image::Point q = p + d;
      if (thinned_.at(q) == 0 || seen_.at(q) != 0) continue;
      const int other = node_of_.at(q);
      if (other < 0) {
        walk(node, p, q);
      } else if (other > node) {  // two nodes side by side, one of them a tip
        add_segment({graph_.nodes[node].position_px, graph_.nodes[other].position_px}, node, other);
      }
    }
  }

  void walk(int node, image::Point from, image::Point at) {
    std::vector<Vector2f> points{graph_.nodes[node].position_px};
    while (true) {
      seen_.at(at) = 1;
      points.push_back(vec(at));
      image::Point next{-1, -1};
      for (const Step& d : kAround) {
        const image::Point q = at + d;
        if (q != from && thinned_.at(q) != 0) next = q;
      }
      if (next.x < 0) return;  // cannot be: a chain pixel has two neighbours
      const int other = node_of_.at(next);
      if (other >= 0) {
        points.push_back(graph_.nodes[other].position_px);
        add_segment(std::move(points), node, other);
        return;
      }
      if (seen_.at(next) != 0) return;
      from = std::exchange(at, next);
    }
  }

  void add_ring(image::Point start) {
    std::vector<Vector2f> points;
    image::Point at = start;
    bool moved = true;
    while (moved) {
      seen_.at(at) = 1;
      points.push_back(vec(at));
      moved = false;
      for (const Step& d : kAround) {
        const image::Point q = at + d;
        if (thinned_.at(q) != 0 && seen_.at(q) == 0) {
          at = q;
          moved = true;
          break;
        }
      }
    }
    rotate_ring(points);
    add_segment(std::move(points), -1, -1);
  }

  void add_segment(std::vector<Vector2f> points, int a, int b);

  const image::Mask& thinned_;
  const image::Image<float>& distance_;
  image::Image<int> node_of_;
  image::Mask degree_;
  image::Mask seen_;
  std::vector<image::Point> pixels_;
  Graph graph_;
};

void Tracer::add_segment(std::vector<Vector2f> points, int a, int b) {
  const auto id = static_cast<int>(graph_.segments.size());
  const float length = length_of(points);
  if (a == b && a >= 0 && length < 4) return;  // a knot of pixels, not a loop
  graph_.segments.push_back({std::move(points), {a, b}, length, true});
  if (a >= 0) graph_.nodes[a].ends.push_back(2 * id);
  if (b >= 0) graph_.nodes[b].ends.push_back(2 * id + 1);
}

// A node where only two ends are left is a point of one longer segment.
void dissolve(Graph& graph, int node_id) {
  Node& node = graph.nodes[node_id];
  if (node.ends.size() != 2) return;
  const int a = node.ends[0];
  const int b = node.ends[1];
  node.ends.clear();
  Segment& kept = graph.segments[a / 2];
  if (a / 2 == b / 2) {
    kept.points_px.pop_back();
    rotate_ring(kept.points_px);
    kept.node = {-1, -1};
    return;
  }
  Segment& gone = graph.segments[b / 2];
  if (a % 2 == 0) std::reverse(kept.points_px.begin(), kept.points_px.end());
  if (b % 2 == 1) std::reverse(gone.points_px.begin(), gone.points_px.end());
  const int near = kept.node[a % 2 == 0 ? 1 : 0];
  const int far = gone.node[b % 2 == 0 ? 1 : 0];
  const int old_far_end = b % 2 == 0 ? b + 1 : b - 1;
  kept.points_px.insert(kept.points_px.end(), gone.points_px.begin() + 1, gone.points_px.end());
  kept.length_px += gone.length_px;
  kept.node = {near, far};
  if (a % 2 == 0 && near >= 0) {  // reversed: its other end is side 0 now
    std::replace(graph.nodes[near].ends.begin(), graph.nodes[near].ends.end(), a + 1, a);
  }
  if (far >= 0) {
    auto& ends = graph.nodes[far].ends;
    std::replace(ends.begin(), ends.end(), old_far_end, 2 * (a / 2) + 1);
  }
  gone.alive = false;
  gone.points_px.clear();
}

void remove(Graph& graph, int segment_id) {
  Segment& segment = graph.segments[segment_id];
  segment.alive = false;
  for (int side = 0; side < 2; ++side) {
    const int node = segment.node[side];
    if (node < 0) continue;
    auto& ends = graph.nodes[node].ends;
    ends.erase(std::remove(ends.begin(), ends.end(), 2 * segment_id + side), ends.end());
  }
  for (const int node : segment.node) {
    if (node >= 0) dissolve(graph, node);
  }
  segment.points_px.clear();
}

bool tip(const Graph& graph, int node) { return graph.nodes[node].ends.size() == 1; }

// How far the branch reaches out of the strand it leaves; negative for what is no branch.
float protrusion(const Graph& graph, const Segment& segment) {
  if (!segment.alive || segment.ring() || segment.node[0] == segment.node[1]) return -1;
  if (tip(graph, segment.node[0]) == tip(graph, segment.node[1])) return -1;
  const int side = tip(graph, segment.node[0]) ? 0 : 1;
  const float out =
      graph.nodes[segment.node[side]].distance_px - graph.nodes[segment.node[1 - side]].distance_px;
  return std::max(0.0F, segment.length_px + out);
}

// The width of what sticks out of the strand.
float spur_width(const Graph& graph, const Segment& segment, const image::Image<float>& distance) {
  const int side = tip(graph, segment.node[0]) ? 1 : 0;
  const Node& root = graph.nodes[segment.node[side]];
  float thickest = 0;
  for (const Vector2f& p : segment.points_px) {
    if ((p - root.position_px).norm() < root.distance_px + 1) continue;
    thickest =
        std::max(thickest, distance.at(geometry::nearest_px(p.y()), geometry::nearest_px(p.x())));
  }
  return width_at(thickest);
}

bool spur(const Graph& graph, const Segment& segment, const image::Image<float>& distance,
          float width) {
  const float reach = protrusion(graph, segment);
  if (reach < 0 || reach >= std::max(kWhiskerWidths * width, kSpurPx)) return false;
  if (reach < std::max(kSpurPx, kStumpWidths * width)) return true;
  return spur_width(graph, segment, distance) < kWhiskerShare * width ||
         reach < (width < kThinPx ? kSpurWidths * width : 0);
}

void prune(Graph& graph, const image::Image<float>& distance, float width) {
  for (int round = 0; round < kPruningRounds; ++round) {
    std::vector<std::pair<float, int>> spurs;
    for (int i = 0; i < static_cast<int>(graph.segments.size()); ++i) {
      const Segment& segment = graph.segments[i];
      if (spur(graph, segment, distance, width)) {
        spurs.emplace_back(protrusion(graph, segment), i);
      }
    }
    if (spurs.empty()) return;
    std::sort(spurs.begin(), spurs.end());
    for (const auto& [reach, id] : spurs) {
      if (protrusion(graph, graph.segments[id]) != reach) continue;  // merged in the meantime
      remove(graph, id);
      ++graph.pruned;
    }
  }
}

// The usual width. Where strands lie beside each other the mask is twice as wide: the median is
// taken over what is not much wider than the narrow parts.
float usual_width(const Graph& graph, const image::Image<float>& distance, float fallback) {
  std::vector<float> distances;
  for (const Segment& segment : graph.segments) {
    if (!segment.alive) continue;
    for (const Vector2f& p : segment.points_px) {
      distances.push_back(distance.at(geometry::nearest_px(p.y()), geometry::nearest_px(p.x())));
    }
  }
  if (distances.empty()) return fallback;
  std::sort(distances.begin(), distances.end());
  const float narrow = distances[distances.size() / 5];
  const auto end = std::upper_bound(distances.begin(), distances.end(), kSingleShare * narrow);
  return std::max(1.0F, width_at(distances[static_cast<std::size_t>(end - distances.begin()) / 2]));
}

}  // namespace

int least_segments(const image::Mask& mask) {
  int euler = 0;  // pieces less holes: corners, less sides, and faces of all pixels, each once
  for (int v = 0; v + 1 < mask.height(); ++v) {
    const std::uint8_t* row = mask.row(v);
    const std::uint8_t* down = mask.row(v + 1);
    int here = 0;
    for (int u = 0; u + 1 < mask.width(); ++u) {
      const int beside = row[u] | row[u + 1];
      const int below = row[u] | down[u];
      here += (beside | below | down[u + 1]) - beside - below + row[u];
    }
    euler += here;
  }
  return std::max(0, -euler);
}

Graph make_graph(const image::Mask& thinned, const Region& region) {
  Graph graph = Tracer(thinned, region.distance_px).run();
  for (int i = 0; i < static_cast<int>(graph.nodes.size()); ++i) dissolve(graph, i);
  prune(graph, region.distance_px, region.width_px);
  graph.width_px = usual_width(graph, region.distance_px, region.width_px);
  return graph;
}

}  // namespace flowdlo::path
