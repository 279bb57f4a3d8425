#include "baselines/traced_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "baselines/crossing_graph.hpp"

namespace flowdlo::baselines {
namespace {

constexpr double kDistortedInRadii = 1.5;
constexpr double kTangentSpanInRadii = 3;
constexpr std::size_t kMostBranches = 4;

// 2 (t1 x t2) / (1 + t1 . t2) of coming in along t1 and leaving along t2.
double bend(const cv::Point2f& out_a, const cv::Point2f& out_b) {
  const cv::Point2f leave(-out_b.x, -out_b.y);
  const float along = 1 + out_a.dot(leave);
  if (along <= 1e-6F) return std::numeric_limits<float>::max();
  return std::abs(2.0 * static_cast<double>(static_cast<float>(out_a.cross(leave)) / along));
}

// The partner of each stroke end, or -1.
class Passages {
 public:
  explicit Passages(const CrossingGraph& graph)
      : graph_(graph), partner_(graph.crossing_of.size(), -1) {}

  bool pass(int crossing) {
    const auto ends = graph_.ends_at(crossing);
    if (ends.size() > kMostBranches) return false;
    if (ends.size() < 2) return true;
    if (ends.size() == 4) {
      pass_four(ends);
      return true;
    }
    std::pair<int, int> best{ends[0], ends[1]};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        if (const double here = bend_of(ends[a], ends[b]); here < least) {
          least = here;
          best = {ends[a], ends[b]};
        }
      }
    }
    pair(best.first, best.second);
    return true;
  }

  [[nodiscard]] int partner(int end) const { return partner_[static_cast<std::size_t>(end)]; }

 private:
  void pass_four(const std::vector<int>& e) {
    const std::array<std::array<std::size_t, 4>, 3> ways{
        {{{0, 1, 2, 3}}, {{0, 2, 1, 3}}, {{0, 3, 1, 2}}}};
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t w = 0; w < ways.size(); ++w) {
      const auto& way = ways[w];
      const double here = bend_of(e[way[0]], e[way[1]]) + bend_of(e[way[2]], e[way[3]]);
      if (here >= least) continue;
      least = here;
      best = w;
    }
    pair(e[ways[best][0]], e[ways[best][1]]);
    pair(e[ways[best][2]], e[ways[best][3]]);
  }

  [[nodiscard]] double bend_of(int a, int b) const { return bend(out(a), out(b)); }

  [[nodiscard]] cv::Point2f out(int end) const {
    return direction_out(graph_.strokes[static_cast<std::size_t>(end / 2)], end % 2 == 1,
                         kDistortedInRadii * graph_.radius_px,
                         kTangentSpanInRadii * graph_.radius_px);
  }

  void pair(int a, int b) {
    partner_[static_cast<std::size_t>(a)] = b;
    partner_[static_cast<std::size_t>(b)] = a;
  }

  const CrossingGraph& graph_;
  std::vector<int> partner_;
};

// From the free or unpaired end `end` along the pairings.
Stroke walk(const CrossingGraph& graph, const Passages& passages, int end) {
  Stroke path;
  for (std::size_t steps = 0; steps <= graph.strokes.size(); ++steps) {
    Stroke piece = graph.strokes[static_cast<std::size_t>(end / 2)];
    if (end % 2 == 1) std::reverse(piece.begin(), piece.end());
    path.insert(path.end(), piece.begin(), piece.end());
    end = passages.partner(end ^ 1);
    if (end < 0) break;
    path.push_back(
        graph.places[static_cast<std::size_t>(graph.crossing_of[static_cast<std::size_t>(end)])]);
  }
  return path;
}

}  // namespace

Result<Stroke> mbest_path(const cv::Mat& mask) {
  const CrossingGraph graph = crossing_graph(mask);
  Passages passages(graph);
  for (int i = 0; i < static_cast<int>(graph.places.size()); ++i) {
    if (!passages.pass(i)) return Error{ErrorCode::kNoPath, "crossing of more than four branches"};
  }
  Stroke best;
  bool ends = false;
  for (int end = 0; end < static_cast<int>(graph.crossing_of.size()); ++end) {
    const Stroke& stroke = graph.strokes[static_cast<std::size_t>(end / 2)];
    if (stroke.empty() || passages.partner(end) >= 0) continue;
    const bool ring = graph.crossing_of[static_cast<std::size_t>(end)] < 0 && stroke.size() > 4 &&
                      cv::norm(stroke.front() - stroke.back()) < 2;
    if (ring) continue;  // a closed loop has no end
    ends = true;
    Stroke path = walk(graph, passages, end);
    if (length_px(path) > length_px(best)) best = std::move(path);
  }
  if (best.size() >= 2) return best;
  return Error{ErrorCode::kNoPath,
               ends || graph.strokes.empty() ? "mask holds no line" : "closed loop without an end"};
}

}  // namespace flowdlo::baselines
