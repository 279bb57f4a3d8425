#include "synth/stereo_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "synth/still_life.hpp"

namespace flowdlo::synth {
namespace {

using test::StillLife;

constexpr StereoRig kRig = {424, 240, 300, 0.015, 0.05, 0.029, true};

/// Of one scene: what the matched depth is off by, metres.
struct Matched {
  double table_m = 0;     ///< median of absolute values
  double rope_m = 0;      ///< median along the ridge, deeper above 0
  double table_seen = 0;  ///< share of the table's pixels that have a depth
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> depth_of(const StillLife& scene, const StereoRig& rig, std::uint64_t index) {
  Dice dice({Split::kWide, Part::kTraining, 0, index}, Use::kInfrared);
  const auto eyes = infrared(scene.view, rig, scene.ropes(), {}, dice);
  EXPECT_TRUE(eyes) << eyes.error().message;
  if (!eyes) return {};
  const auto depth_m = matched(scene.view, rig, *eyes, 0.9 * scene.view.distance_m);
  EXPECT_TRUE(depth_m) << depth_m.error().message;
  return depth_m ? *depth_m : std::vector<float>();
}

Matched compare(const StillLife& scene, const std::vector<float>& depth_m) {
  std::vector<double> table;
  std::vector<double> rope;
  int pixels = 0;
  for (int v = 20; v < 220; ++v) {
    for (int u = 90; u < 300; ++u) {
      const auto i = static_cast<std::size_t>(v * scene.sensor.width + u);
      const double off =
          static_cast<double>(depth_m[i]) - static_cast<double>(scene.picture.depth_m[i]);
      if (std::abs(v - 119) > 30) {
        ++pixels;
        if (depth_m[i] > 0) table.push_back(std::abs(off));
      } else if (std::abs(v - 119) <= 1 && u < 230 && depth_m[i] > 0) {
        rope.push_back(off);
      }
    }
  }
  EXPECT_GT(rope.size(), 50U);
  EXPECT_GT(table.size(), 1000U);
  if (rope.empty() || table.empty()) return {};
  return {median(table), median(rope), static_cast<double>(table.size()) / pixels};
}

TEST(StereoPair, MeasuresATable) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  const Matched found = compare(scene, depth_of(scene, kRig, 1));
  EXPECT_LT(found.table_m, 0.004);  // a quarter of a pixel of disparity
  EXPECT_GT(found.table_seen, 0.9);
}

TEST(StereoPair, PullsAThinRopeTowardsTheTable) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  StereoRig coarse = kRig;  // to which the rope is 6 px wide, and 0.6 px of disparity high
  coarse.width /= 2;
  coarse.height /= 2;
  coarse.focal_px /= 2;
  const Matched found = compare(scene, depth_of(scene, coarse, 2));
  EXPECT_GT(found.rope_m, 0.2 * scene.rope.radius_m);
  EXPECT_LT(found.rope_m, 2.2 * scene.rope.radius_m);
}

TEST(StereoPair, IsTheSameEachTime) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  EXPECT_EQ(depth_of(scene, kRig, 3), depth_of(scene, kRig, 3));
  EXPECT_NE(depth_of(scene, kRig, 3), depth_of(scene, kRig, 4));
}

TEST(StereoPair, DotsAreSeenByBothEyes) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  Dice with({}, Use::kInfrared);
  Dice without({}, Use::kInfrared);
  StereoRig plain = kRig;
  plain.has_dots = false;
  const auto lit = infrared(scene.view, kRig, scene.ropes(), {}, with);
  const auto unlit = infrared(scene.view, plain, scene.ropes(), {}, without);
  ASSERT_TRUE(lit && unlit);
  const auto contrast = [](const std::vector<std::uint8_t>& image) {
    double sum = 0;
    for (std::size_t i = 1; i < image.size(); ++i) sum += std::abs(image[i] - image[i - 1]);
    return sum / static_cast<double>(image.size());
  };
  EXPECT_GT(contrast(lit->left), 2 * contrast(unlit->left));
  EXPECT_GT(contrast(lit->right), 2 * contrast(unlit->right));
}

TEST(StereoPair, OnlyStereoCamerasAreMatched) {
  for (const Sensor& sensor : sensors()) {
    EXPECT_EQ(rig_of(sensor).has_value(), sensor.principle == DepthPrinciple::kStereo)
        << sensor.name;
  }
}

TEST(StereoPair, AFrameIsMatchedWhereItsCameraIsAStereoCamera) {
  int stereo = 0;
  for (std::uint64_t index = 0; index < 3; ++index) {
    const auto modelled = make_frame(Split::kWide, Part::kTraining, 0, index, {.color = false});
    const auto matched =
        make_frame(Split::kWide, Part::kTraining, 0, index, {.color = false, .matched = true});
    ASSERT_TRUE(modelled && matched);
    EXPECT_EQ(modelled->truth(), matched->truth());
    EXPECT_EQ(modelled->folder.mask, matched->folder.mask);
    const bool is_stereo = matched->meta.camera == modelled->meta.camera + ", matched";
    stereo += is_stereo ? 1 : 0;
    EXPECT_EQ(modelled->folder.depth_m == matched->folder.depth_m, !is_stereo);
  }
  EXPECT_GT(stereo, 0);
}

}  // namespace
}  // namespace flowdlo::synth
