// What an estimate's confidence says of masks that are no rope, two ropes or half of one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "flowdlo/estimator.hpp"
#include "hostile/hostile_mask.hpp"
#include "one_rope/part_of_rope.hpp"
#include "one_rope/two_ropes.hpp"
#include "scene/scene.hpp"

namespace flowdlo {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

constexpr float kLow = 0.3F;

FrameFolder drawn(lab::Kind kind, std::uint64_t seed) {
  auto scene = lab::make_scene(kind, seed);
  FrameFolder frame;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  frame.intrinsics = scene.image.camera;
  frame.depth_m = std::move(scene.image.depth_m);
  frame.mask = std::move(scene.image.mask);
  frame.truth = scene.truth;
  return frame;
}

/// On a table that comes nearer from top to bottom.
FrameFolder table(int width, int height) {
  FrameFolder frame;
  frame.width = width;
  frame.height = height;
  const auto focal = static_cast<float>(std::max(width, height));
  frame.intrinsics = {focal, focal, static_cast<float>(width) / 2, static_cast<float>(height) / 2};
  for (int i = 0; i < width * height; ++i) {
    frame.depth_m.push_back(0.7F -
                            0.1F * static_cast<float>(i / width) / static_cast<float>(height));
  }
  return frame;
}

class Confidence : public ::testing::TestWithParam<GateChoice> {
 protected:
  /// 0 where there is no estimate.
  float of(const FrameFolder& frame) {
    const auto estimate = estimator_.estimate(frame.frame());
    doubts = estimate ? estimate->one_rope.doubts : std::vector<Doubt>{};
    return estimate ? estimate->confidence : 0;
  }

  std::vector<Doubt> doubts;

 private:
  static Estimator make() {
    auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                                        .device = "cpu",
                                        .quality = Quality::kFast,
                                        .gate = GetParam(),
                                        .threads = 1});
    if (!estimator) throw std::runtime_error(estimator.error().message);
    return *std::move(estimator);
  }
  Estimator estimator_ = make();
};

INSTANTIATE_TEST_SUITE_P(Gates, Confidence,
                         ::testing::Values(GateChoice::kThesis, GateChoice::kCalibrated),
                         [](const auto& gate) {
                           return gate.param == GateChoice::kThesis ? "thesis" : "calibrated";
                         });

TEST_P(Confidence, OfAFullMaskIsBelowThreeTenths) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{64, 64}, {320, 240}, {640, 480}, {640, 64}, {40, 400}}) {
    FrameFolder frame = table(width, height);
    frame.mask.assign(frame.depth_m.size(), 255);
    EXPECT_LT(of(frame), kLow) << width << " x " << height;
  }
}

TEST_P(Confidence, OfAMaskThatIsNoRopeIsBelowThreeTenths) {
  FrameFolder frame = table(160, 120);
  const auto odd = lab::ropeless_masks({frame.width, frame.height});
  for (std::size_t i = 0; i < odd.size(); i += 2) {
    const cv::Mat1b mask = lab::draw(odd[i]);
    frame.mask.assign(mask.begin(), mask.end());
    EXPECT_LT(of(frame), kLow) << odd[i].name();
  }
}

TEST_P(Confidence, OfTwoCrossingRopesIsBelowThreeTenthsInMostScenes) {
  int scenes = 0;
  int low = 0;
  for (std::uint64_t seed = 8000200; seed < 8000260; ++seed) {
    const auto pair =
        lab::two_ropes(drawn(lab::Kind::kSimple, seed), drawn(lab::Kind::kHanging, seed),
                       lab::Arrangement::kCrossing, seed);
    if (!pair) continue;
    ++scenes;
    low += of(*pair) < kLow ? 1 : 0;
  }
  EXPECT_GE(scenes, 40);
  EXPECT_GE(3 * low, 2 * scenes) << low << " of " << scenes;
}

TEST_P(Confidence, OfHalfARopeWhoseRestIsSeenInDepthIsBelowThreeTenths) {
  for (std::uint64_t seed = 8000200; seed < 8000202; ++seed) {
    const auto whole = drawn(lab::Kind::kSimple, seed);
    EXPECT_LT(of(lab::part_of_rope(whole, 0, 0.5)), kLow) << seed;
    EXPECT_THAT(doubts, Contains(Doubt::kGoesOn)) << seed;
  }
}

TEST_P(Confidence, OfSingleRopesStaysAsItIs) {
  for (int kind = 0; kind < lab::kKinds; ++kind) {
    const auto frame = drawn(static_cast<lab::Kind>(kind), 8000200);
    EXPECT_GT(of(frame), kLow) << lab::name_of(static_cast<lab::Kind>(kind));
    EXPECT_THAT(doubts, IsEmpty()) << lab::name_of(static_cast<lab::Kind>(kind));
  }
}

}  // namespace
}  // namespace flowdlo
