#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "synth/flat_shape.hpp"
#include "synth/rope.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

constexpr std::uint64_t kScenes = 16;

SyntheticFrame tangled(std::uint64_t index, const Render& render) {
  auto frame = make_frame(Split::kTangled, Part::kTraining, 7, index, render);
  EXPECT_TRUE(frame) << frame.error().message;
  return frame ? std::move(*frame) : SyntheticFrame{};
}

FlatPoints from_above(const Curve& curve) {
  FlatPoints points;
  for (const Vector3d& p : curve.points) points.emplace_back(p.x(), p.y());
  return points;
}

TEST(TangledRopes, AreTwoToSixThatLieOnEachOtherAndNeverRunThroughEachOther) {
  std::set<std::string> scenarios;
  for (std::uint64_t index = 0; index < kScenes; ++index) {
    const auto frame = tangled(index, {.color = false, .dense = true});
    scenarios.insert(frame.meta.scenario);
    const auto& curves = frame.dense->curves;
    ASSERT_GE(curves.size(), 2U);
    ASSERT_LE(curves.size(), 6U);
    EXPECT_FALSE(frame.meta.hanging);
    const auto& labels = frame.folder.instances;
    EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), static_cast<int>(curves.size()));
    for (std::size_t a = 0; a < curves.size(); ++a) {
      bool near_another = false;
      for (std::size_t b = 0; b < curves.size(); ++b) {
        if (a == b) continue;
        const double sum = frame.ropes[a].radius_m + frame.ropes[b].radius_m;
        const double apart = distance_m(curves[a], curves[b], 2 * sum);
        EXPECT_GE(apart, 0.97 * sum) << index;
        near_another = near_another || apart < 1.5 * sum;
      }
      EXPECT_TRUE(near_another) << index << " " << a;
    }
  }
  EXPECT_EQ(scenarios.size(), kTangledScenarios.size());
}

TEST(TangledRopes, CrossThemselvesAndFlatterThanTidyOnes) {
  int own = 0;
  double flattest = 1;
  Dice dice({Split::kTangled, Part::kTraining, 1, 0}, Use::kRope);
  for (int k = 0; k < 60; ++k) {
    const auto ropes = try_tangled_ropes("tangled-loops", dice);
    if (!ropes) continue;
    for (std::size_t a = 0; a < ropes->size(); ++a) {
      own += !crossings(from_above((*ropes)[a].curve)).empty();
      for (std::size_t b = a + 1; b < ropes->size(); ++b) {
        for (const auto& c :
             crossings(from_above((*ropes)[a].curve), from_above((*ropes)[b].curve))) {
          flattest = std::min(flattest, c.sine);
        }
      }
    }
  }
  EXPECT_GE(own, 10);
  EXPECT_LT(flattest, 0.3);
  EXPECT_GT(flattest, 0.1);
}

TEST(Looped, CrossesItselfOnceALoopAndNoBendIsTooTight) {
  Dice dice({Split::kTangled, Part::kTraining, 2, 0}, Use::kRope);
  const Gauge gauge{.length_m = 0.9, .radius_m = 0.003, .least_bend_m = 0.015};
  for (const int loops : {1, 2, 3}) {
    const auto points = looped(gauge, loops, dice);
    ASSERT_TRUE(points);
    EXPECT_GE(crossings(*points).size(), static_cast<std::size_t>(loops));
    std::vector<Vector3d> flat;
    for (const Vector2d& p : *points) flat.emplace_back(p.x(), p.y(), 0);
    const Curve curve = respaced(flat, 0.5 * gauge.radius_m);
    EXPECT_NEAR(curve.length_m(), gauge.length_m, 0.01 * gauge.length_m);
    // A loop may add its bend to that of the line it lies in.
    EXPECT_GT(least_bend_radius_m(curve, gauge.radius_m), 0.7 * gauge.least_bend_m);
  }
}

}  // namespace
}  // namespace flowdlo::synth
