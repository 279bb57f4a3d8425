#include "path/loops.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kBesideWidths = 2.5F;  // two links at one place are no farther apart
constexpr std::size_t kStride = 4;     // points of a strand that one step takes

struct Step {
  Vector2f from;
  Vector2f to;
};

std::vector<Step> links_of(const Traversal& way, const Strands& strands) {
  std::vector<Step> links;
  const std::size_t count = way.enters.size();
  for (std::size_t i = 0; i + (way.closed ? 0 : 1) < count; ++i) {
    const int from = way.enters[i] ^ 1;
    const int to = way.enters[(i + 1) % count];
    if (strands.list[static_cast<std::size_t>(to / 2)].ring) continue;  // closed without a link
    links.push_back({strands.end(from).point_px, strands.end(to).point_px});
  }
  return links;
}

/// All of a way: its links, and a few pixels of a strand a step.
std::vector<Step> steps_of(const Traversal& way, const Strands& strands) {
  std::vector<Step> steps = links_of(way, strands);
  for (const int enter : way.enters) {
    const auto& points = strands.list[static_cast<std::size_t>(enter / 2)].points_px;
    for (std::size_t i = 0; i + 1 < points.size(); i += kStride) {
      steps.push_back({points[i], points[std::min(i + kStride, points.size() - 1)]});
    }
  }
  return steps;
}

float apart_px(const Step& a, const Step& b) {
  return std::min({(a.from - b.from).norm(), (a.from - b.to).norm(), (a.to - b.from).norm(),
                   (a.to - b.to).norm()});
}

/// Above 0 on one side of the line through a step, below on the other.
float side_of(const Step& step, const Vector2f& p) {
  const Vector2f along = step.to - step.from;
  const Vector2f off = p - step.from;
  return along.x() * off.y() - along.y() * off.x();
}

bool cross(const Step& a, const Step& b) {
  return side_of(a, b.from) * side_of(a, b.to) < 0 && side_of(b, a.from) * side_of(b, a.to) < 0;
}

/// Whether any of `a` meets any of `b` so.
template <class Meets>
bool any_meets(const std::vector<Step>& a, const std::vector<Step>& b, const Meets& meets) {
  return std::any_of(a.begin(), a.end(), [&](const Step& one) {
    return std::any_of(b.begin(), b.end(), [&](const Step& other) { return meets(one, other); });
  });
}

}  // namespace

bool may_be_loop(const Traversal& ring, const RopeSet& set, const Strands& strands) {
  const auto others_meet = [&](const auto& steps_of_way, const auto& meets) {
    const std::vector<Step> own = steps_of_way(ring, strands);
    return std::any_of(set.ways.begin(), set.ways.end(), [&](const Traversal& way) {
      return &way != &ring && any_meets(own, steps_of_way(way, strands), meets);
    });
  };
  const float beside_px = kBesideWidths * strands.scale_px;
  const bool touched = others_meet(
      links_of, [&](const Step& a, const Step& b) { return apart_px(a, b) < beside_px; });
  return touched && !others_meet(steps_of, cross);
}

}  // namespace flowdlo::path
