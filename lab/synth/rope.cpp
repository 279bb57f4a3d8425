#include "synth/rope.hpp"

#include <algorithm>

namespace flowdlo::synth {
namespace {

constexpr double kSeparation = 1.95;  // radii
constexpr double kTightest = 3.0;     // radii
constexpr double kClosing = 8.0;      // radii

}  // namespace

bool sound(const Rope& rope) {
  const bool finite = std::all_of(rope.curve.points.begin(), rope.curve.points.end(),
                                  [](const Vector3d& p) { return p.allFinite(); });
  if (!finite || least_bend_radius_m(rope.curve, rope.radius_m) < kTightest * rope.radius_m) {
    return false;
  }
  Curve open = rope.curve;  // without the stretch on which a ring comes back to where it began
  if (rope.closed) {
    const double kept = open.length_m() - kClosing * rope.radius_m;
    open.points.resize(static_cast<std::size_t>(std::max(2.0, kept / open.step_m)));
  }
  return nearness(open, rope.radius_m).least_m >= kSeparation * rope.radius_m;
}

}  // namespace flowdlo::synth
