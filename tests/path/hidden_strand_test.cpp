// Rendered scenes whose loops in the air are seen edge-on: one strand lies behind another.
#include <gtest/gtest.h>

#include <algorithm>

#include "path/path.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::test {
namespace {

// Share of the truth's nodes, in order, that the path passes within a width of, in order.
double walked_in_order(const path::Path& path, const Centerline& truth, const Frame& frame) {
  std::size_t at = 0;
  int passed = 0;
  for (const Point3& node : truth) {
    const Eigen::Vector2f pixel(frame.intrinsics.fx * node.x / node.z + frame.intrinsics.cx,
                                frame.intrinsics.fy * node.y / node.z + frame.intrinsics.cy);
    for (std::size_t i = at; i < path.points_px.size(); ++i) {
      if ((path.points_px[i] - pixel).norm() > path.width_px) continue;
      at = i;
      ++passed;
      break;
    }
  }
  return passed / static_cast<double>(kNodes);
}

TEST(HiddenStrand, OfALoopSeenEdgeOnIsWalked) {
  const auto made =
      synth::make_frame(synth::Split::kWide, synth::Part::kTraining, 0, 100331, {.color = false});
  ASSERT_TRUE(made);
  const Frame frame = made->frame();
  const auto traced = path::trace(frame);
  ASSERT_TRUE(traced);
  Centerline reversed = made->truth();
  std::reverse(reversed.begin(), reversed.end());
  const path::Path& best = traced->ranked.front();
  EXPECT_EQ(
      std::max(walked_in_order(best, made->truth(), frame), walked_in_order(best, reversed, frame)),
      1.0);
}

}  // namespace
}  // namespace flowdlo::test
