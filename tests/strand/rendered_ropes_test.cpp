#include "reports/rendered_ropes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "scene/ropes.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {
namespace {

double length_m(const Curve3& curve) {
  double sum = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) sum += (curve[i] - curve[i - 1]).norm();
  return sum;
}

// What an estimate may follow below a gripper is the whole rope there, however little that is.
TEST(RenderedRopes, AreKnownFromTipToTipAlsoWhereSomethingHoldsThem) {
  synth::Render render;
  render.color = false;
  render.dense = true;
  int held = 0;
  for (std::uint64_t index = 0; index < 120 && held < 3; ++index) {
    const auto scenario =
        synth::scenario_of(synth::Split::kSeveral, synth::Part::kTraining, 0, index);
    ASSERT_TRUE(scenario);
    if (*scenario != "ropes-hanging") continue;
    const auto made = rendered_ropes(synth::Split::kSeveral, synth::Part::kTraining, index);
    ASSERT_TRUE(made);
    if (!*made) continue;
    const auto frame =
        synth::make_frame(synth::Split::kSeveral, synth::Part::kTraining, 0, index, render);
    ASSERT_TRUE(frame);
    const auto& ropes = (*made)->scene.ropes;
    ASSERT_EQ(ropes.size(), frame->dense->curves.size());
    for (std::size_t k = 0; k < ropes.size(); ++k) {
      const double width_m = 2 * ropes[k].radius_m;
      double known_m = length_m(ropes[k].curve);
      for (const Curve3& unseen : ropes[k].unseen) {
        known_m += length_m(unseen);
        if (length_m(unseen) > width_m) ++held;
      }
      EXPECT_NEAR(known_m, frame->dense->curves[k].length_m(), 0.5 * width_m) << index;
    }
  }
  EXPECT_GE(held, 3);
}

}  // namespace
}  // namespace flowdlo::lab
