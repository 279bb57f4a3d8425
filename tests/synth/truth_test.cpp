// The truth of a frame agrees with its pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

struct Pixel {
  bool inside = false;
  std::size_t index = 0;
};

Pixel pixel_of(const FrameFolder& folder, const Point3& node) {
  const auto u = std::lround(folder.intrinsics.fx * node.x / node.z + folder.intrinsics.cx);
  const auto v = std::lround(folder.intrinsics.fy * node.y / node.z + folder.intrinsics.cy);
  const bool inside = u >= 0 && v >= 0 && u < folder.width && v < folder.height;
  return {inside, inside ? static_cast<std::size_t>(v * folder.width + u) : 0};
}

std::vector<SyntheticFrame> frames(Split split, std::uint64_t count) {
  std::vector<SyntheticFrame> result;
  const std::uint64_t every = split == Split::kThesis ? 5 : 1;
  for (std::uint64_t k = 0; k < count; ++k) {
    auto frame = make_frame(split, Part::kTraining, 0, every * k, {.color = false});
    EXPECT_TRUE(frame) << frame.error().message;
    if (frame) result.push_back(std::move(*frame));
  }
  return result;
}

TEST(Truth, IsUniformInArclengthAndAsLongAsTheRope) {
  for (const auto& frame : frames(Split::kWide, 60)) {
    const double even = frame.meta.length_m / (kNodes - 1);
    for (std::size_t i = 1; i < kNodes; ++i) {
      const Point3& a = frame.truth()[i - 1];
      const Point3& b = frame.truth()[i];
      const double chord = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
      EXPECT_LE(chord, 1.001 * even) << frame.folder.name;
      // The chord of an arc as tight as the rope's tightest bend, at the least.
      const double bend = 0.8 * frame.meta.least_bend_radius_m;
      const double angle = std::min(3.14, even / bend);
      EXPECT_GE(chord, 0.97 * 2 * bend * std::sin(0.5 * angle)) << frame.folder.name;
    }
  }
}

TEST(Truth, LiesARadiusBehindTheDepthOfThesisFrames) {  // seen from within 15 degrees of above
  int compared = 0;
  for (const auto& frame : frames(Split::kThesis, 40)) {
    int far_off = 0;
    for (const Point3& node : frame.truth()) {
      const Pixel pixel = pixel_of(frame.folder, node);
      ASSERT_TRUE(pixel.inside);
      const double surface = frame.folder.depth_m[pixel.index] + frame.meta.radius_m;
      ++compared;
      // Deeper nodes are the lower strand's at a crossing, or stand steeply.
      if (std::abs(surface - node.z) > 0.25 * frame.meta.radius_m + 0.0005) ++far_off;
    }
    EXPECT_LE(far_off, frame.meta.crossings > 0 ? 4 * frame.meta.crossings + 4 : 3)
        << frame.folder.name;
  }
  EXPECT_EQ(compared, 40 * kNodes);
}

TEST(Truth, IsCoveredByTheMaskOfThesisFrames) {
  for (const auto& frame : frames(Split::kThesis, 40)) {
    int bare = 0;
    for (const Point3& node : frame.truth()) {
      const Pixel pixel = pixel_of(frame.folder, node);
      bare += frame.folder.mask[pixel.index] <= 127 ? 1 : 0;
    }
    EXPECT_LE(bare, 2) << frame.folder.name;  // the two ends, where a pixel's centre is beyond
  }
}

TEST(Truth, IsCoveredByTheMaskOfWideFramesButForWhatTheMetaAdmits) {
  for (const auto& frame : frames(Split::kWide, 60)) {
    const Defects& defects = frame.meta.defects;
    if (defects.mask_ragged || defects.mask_shifted || frame.meta.width_px < 4) continue;
    double bare = 0;
    for (const Point3& node : frame.truth()) {
      const Pixel pixel = pixel_of(frame.folder, node);
      if (!pixel.inside || frame.folder.mask[pixel.index] <= 127) ++bare;
    }
    if (!defects.gap && !defects.hidden_end && !defects.outside && !defects.mask_gaps) {
      EXPECT_LE(bare, 6) << frame.folder.name;
    }
  }
}

TEST(Truth, TheMaskIsNearTheTruth) {
  for (const auto& frame : frames(Split::kWide, 40)) {
    if (frame.meta.defects.mask_specks) continue;
    const FrameFolder& folder = frame.folder;
    const double fx = folder.intrinsics.fx;
    double nearest_z = 10;
    for (const Point3& node : frame.truth()) nearest_z = std::min<double>(nearest_z, node.z);
    const double spacing = frame.meta.length_m / (kNodes - 1);
    const double reach = fx * (2.5 * frame.meta.radius_m + 0.7 * spacing) / nearest_z + 10;
    for (std::size_t i = 0; i < folder.mask.size(); i += 7) {
      if (folder.mask[i] <= 127) continue;
      const double u = static_cast<double>(i % static_cast<std::size_t>(folder.width));
      const double v = static_cast<double>(i / static_cast<std::size_t>(folder.width));
      double least = 1e9;
      for (const Point3& node : frame.truth()) {
        least = std::min(
            least, std::hypot(fx * node.x / node.z + folder.intrinsics.cx - u,
                              folder.intrinsics.fy * node.y / node.z + folder.intrinsics.cy - v));
      }
      ASSERT_LE(least, reach) << folder.name << " at " << u << ", " << v;
    }
  }
}

}  // namespace
}  // namespace flowdlo::synth
