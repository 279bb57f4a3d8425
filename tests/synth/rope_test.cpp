// What every rope must be: no bend too tight, no strand inside another, none below the table.
#include "synth/rope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "synth/laid_rope.hpp"

namespace flowdlo::synth {
namespace {

// By brute force, of all pairs over eight radii of rope apart.
double least_distance(const Curve& curve, double radius_m) {
  const auto& points = curve.points;
  const auto apart = static_cast<std::size_t>(8 * radius_m / curve.step_m);
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + apart; j < points.size(); ++j) {
      least = std::min(least, (points[i] - points[j]).squaredNorm());
    }
  }
  return std::sqrt(least);
}

Rope any_rope(Split split, std::string_view scenario, std::uint64_t index) {
  Dice dice({split, Part::kTraining, 1234, index}, Use::kRope);
  for (int k = 0; k < 400; ++k) {
    auto rope =
        split == Split::kThesis ? try_thesis_rope(scenario, dice) : try_wide_rope(scenario, dice);
    if (rope) return *rope;
  }
  ADD_FAILURE() << "no rope of " << scenario;
  return {};
}

struct Case {
  Split split;
  std::string_view scenario;
};

std::string name_of_case(const testing::TestParamInfo<Case>& info) {
  std::string name =
      std::string(name_of(info.param.split)) + "_" + std::string(info.param.scenario);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class EveryRope : public testing::TestWithParam<Case> {};

TEST_P(EveryRope, KeepsItsStrandsApart) {
  for (std::uint64_t index = 0; index < 4; ++index) {
    const Rope rope = any_rope(GetParam().split, GetParam().scenario, index);
    EXPECT_GE(least_distance(rope.curve, rope.radius_m), 1.95 * rope.radius_m) << index;
  }
}

TEST_P(EveryRope, BendsNoTighterThanThreeRadii) {
  for (std::uint64_t index = 0; index < 4; ++index) {
    const Rope rope = any_rope(GetParam().split, GetParam().scenario, index);
    EXPECT_GE(least_bend_radius_m(rope.curve, rope.radius_m), 3 * rope.radius_m) << index;
  }
}

TEST_P(EveryRope, LiesOnTheTableOrHangs) {
  for (std::uint64_t index = 0; index < 4; ++index) {
    const Rope rope = any_rope(GetParam().split, GetParam().scenario, index);
    if (rope.hanging) {
      EXPECT_GE(rope.grippers, 1);
      continue;
    }
    double lowest = 1;
    for (const Vector3d& p : rope.curve.points) lowest = std::min(lowest, p.z());
    EXPECT_NEAR(lowest, rope.radius_m, 0.2 * rope.radius_m) << index;
    EXPECT_GE(lowest, 0.999 * rope.radius_m) << index;
  }
}

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const auto name : kThesisScenarios) cases.push_back({Split::kThesis, name});
  for (const auto name : kWideScenarios) cases.push_back({Split::kWide, name});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Rope, EveryRope, testing::ValuesIn(every_case()), name_of_case);

// A straight strand that turns back and crosses itself at a right angle.
FlatPoints loop() {
  FlatPoints points;
  for (double x = -0.15; x < 0; x += 0.001) points.emplace_back(x, 0);
  for (double a = 0; a < 1.5 * 3.14159; a += 0.001 / 0.06) {
    points.emplace_back(0.06 * std::sin(a), 0.06 * (1 - std::cos(a)));
  }
  const Vector2d end = points.back();
  for (double y = 0.001; y < 0.2; y += 0.001) points.emplace_back(end.x(), end.y() - y);
  return points;
}

TEST(Laid, TheUpperStrandRestsOnTheLower) {
  const Gauge gauge{.length_m = 0.6, .radius_m = 0.004, .least_bend_m = 0.02};
  Dice dice({Split::kWide, Part::kTraining, 1, 1}, Use::kRope);
  const auto curve = laid(loop(), gauge, {.in_order = true}, dice);
  ASSERT_TRUE(curve);

  double highest = 0;
  for (const Vector3d& p : curve->points) highest = std::max(highest, p.z());
  EXPECT_NEAR(highest, 3 * gauge.radius_m, 0.4 * gauge.radius_m);
  EXPECT_GE(least_distance(*curve, gauge.radius_m), 1.95 * gauge.radius_m);
}

TEST(Laid, TheLiftIsSmooth) {
  const Gauge gauge{.length_m = 0.6, .radius_m = 0.004, .least_bend_m = 0.02};
  Dice dice({Split::kWide, Part::kTraining, 1, 1}, Use::kRope);
  const auto curve = laid(loop(), gauge, {.in_order = true}, dice);
  ASSERT_TRUE(curve);

  EXPECT_GE(least_bend_radius_m(*curve, gauge.radius_m), 4 * gauge.radius_m);
}

}  // namespace
}  // namespace flowdlo::synth
