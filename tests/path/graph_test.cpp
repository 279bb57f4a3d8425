#include "path/graph.hpp"

#include <gtest/gtest.h>

#include "canvas.hpp"
#include "path/strands.hpp"
#include "path/thinning.hpp"

namespace flowdlo::test {
namespace {

path::Graph graph_of(const Canvas& canvas) {
  const auto region = path::clean(canvas.frame());
  return path::make_graph(path::thin(region->mask), *region);
}

int alive(const path::Graph& graph) {
  int count = 0;
  for (const auto& segment : graph.segments) count += segment.alive ? 1 : 0;
  return count;
}

TEST(Graph, StrokeIsOneSegment) {
  EXPECT_EQ(alive(graph_of(Canvas().stroke({{100, 200}, {400, 300}}, 12))), 1);
}

TEST(Graph, CrossHasFourArms) {
  const Canvas canvas =
      Canvas().stroke({{100, 240}, {540, 240}}, 8).stroke({{320, 60}, {320, 420}}, 8);
  const auto region = path::clean(canvas.frame());
  const auto graph = path::make_graph(path::thin(region->mask), *region);
  const auto strands = path::make_strands(graph, *region, canvas.frame());
  EXPECT_EQ(strands.list.size(), 4U) << "forks beside each other are one crossing";
}

TEST(Graph, ForkedTipsOfASquareCutEndArePruned) {
  Canvas canvas;
  canvas.mask(cv::Rect{100, 200, 400, 60}) = 255;
  EXPECT_EQ(alive(graph_of(canvas)), 1);
}

TEST(Graph, ThornsArePrunedButAShortRopeEndIsNot) {
  const Canvas canvas = Canvas()
                            .stroke({{80, 240}, {560, 240}}, 12)
                            .stroke({{200, 240}, {200, 228}}, 3)    // a thorn
                            .stroke({{400, 240}, {400, 210}}, 12);  // an end
  const auto graph = graph_of(canvas);
  EXPECT_EQ(alive(graph), 3);
  EXPECT_GE(graph.pruned, 1);
}

TEST(Graph, RingIsASegmentWithoutNodes) {
  Canvas canvas;
  cv::circle(canvas.mask, {320, 240}, 100, cv::Scalar(255), 9);
  const auto graph = graph_of(canvas);
  int rings = 0;
  for (const auto& segment : graph.segments) rings += segment.alive && segment.ring() ? 1 : 0;
  EXPECT_EQ(rings, 1);
}

TEST(Graph, EverySegmentIsListedAtItsNodes) {
  Canvas canvas;
  for (int u = 40; u < 600; u += 60) canvas.stroke({{u, 40}, {u + 20, 440}}, 7);
  for (int v = 60; v < 440; v += 60) canvas.stroke({{20, v}, {620, v + 15}}, 7);
  const auto graph = graph_of(canvas);
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const auto& segment = graph.segments[i];
    if (!segment.alive || segment.ring()) continue;
    for (int side = 0; side < 2; ++side) {
      const auto& ends = graph.nodes[static_cast<std::size_t>(segment.node[side])].ends;
      EXPECT_EQ(std::count(ends.begin(), ends.end(), 2 * static_cast<int>(i) + side), 1);
      const Vector2f& point = side == 0 ? segment.points_px.front() : segment.points_px.back();
      const auto& node = graph.nodes[static_cast<std::size_t>(segment.node[side])];
      EXPECT_LT((point - node.position_px).norm(), 1e-3F);
    }
  }
}

TEST(Graph, HasAtLeastAsManySegmentsAsHolesMoreThanPieces) {
  Canvas grid;
  for (int u = 40; u <= 600; u += 80) grid.stroke({{u, 40}, {u, 440}}, 7);
  for (int v = 40; v <= 440; v += 80) grid.stroke({{40, v}, {600, v}}, 7);
  grid.stroke({{10, 10}, {300, 10}}, 5);
  EXPECT_EQ(path::least_segments(path::clean(grid.frame())->mask), 7 * 5 - 2);
  for (const int percent : {1, 3, 6}) {
    Canvas holes;
    holes.mask(cv::Rect{20, 20, 600, 440}) = 255;
    cv::RNG random(static_cast<std::uint64_t>(percent));
    for (int v = 24; v < 450; v += 12) {
      for (int u = 24; u < 610; u += 12) {
        if (random.uniform(0, 20) < percent) holes.erase({u, v, 9, 9});
      }
    }
    const auto region = path::clean(holes.frame());
    const int least = path::least_segments(region->mask);
    EXPECT_GT(least, 10);
    EXPECT_LE(least, alive(path::make_graph(path::thin(region->mask), *region))) << percent;
  }
}

}  // namespace
}  // namespace flowdlo::test
