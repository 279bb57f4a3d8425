#include "synth/rope.hpp"

#include <algorithm>

namespace flowdlo::synth {
namespace {

constexpr double kSeparation = 1.95;  // radii
constexpr double kTightest = 3.0;     // radii

}  // namespace

bool sound(const Rope& rope) {
  const bool finite = std::all_of(rope.curve.points.begin(), rope.curve.points.end(),
                                  [](const Vector3d& p) { return p.allFinite(); });
  return finite && least_bend_radius_m(rope.curve, rope.radius_m) >= kTightest * rope.radius_m &&
         nearness(rope.curve, rope.radius_m).least_m >= kSeparation * rope.radius_m;
}

}  // namespace flowdlo::synth
