#include "path/touches.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/segments.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kLevelShare = 0.1F;  // of their distance: between ropes on each other it is less

struct Step {
  Vector2f from;
  Vector2f to;
  float depth_m = 0;  // in the mean; 0: unknown
};

void add_links(const Traversal& way, const Strands& strands, std::vector<Step>& links) {
  const std::size_t count = way.enters.size();
  for (std::size_t i = 0; i + (way.closed ? 0 : 1) < count; ++i) {
    const int from = way.enters[i] ^ 1;
    const int to = way.enters[(i + 1) % count];
    if (strands.list[static_cast<std::size_t>(to / 2)].ring) continue;  // closed without a link
    const StrandEnd& a = strands.end(from);
    const StrandEnd& b = strands.end(to);
    const bool known = a.depth_m > 0 && b.depth_m > 0;
    const Step link{a.point_px, b.point_px, known ? 0.5F * (a.depth_m + b.depth_m) : 0};
    if (link.from != link.to) links.push_back(link);  // one without a length has no sides
  }
}

bool at_one_place(const Step& a, const Step& b, float within_px) {
  const auto near = [&](const Vector2f& p) {
    return std::min((p - b.from).norm(), (p - b.to).norm()) < within_px;
  };
  return near(a.from) && near(a.to);
}

/// One well before the other: they are not at one place in space.
bool on_two_levels(const Step& a, const Step& b) {
  if (a.depth_m <= 0 || b.depth_m <= 0) return false;
  return std::abs(a.depth_m - b.depth_m) > kLevelShare * std::min(a.depth_m, b.depth_m);
}

bool cross(const Step& a, const Step& b) {
  return geometry::meeting<float>(a.from, a.to - a.from, b.from, b.to - b.from).has_value();
}

}  // namespace

int touches(const RopeSet& set, const Strands& strands) {
  std::vector<Step> links;
  for (const Traversal& way : set.ways) add_links(way, strands, links);
  const float within_px = kTouchWidths * strands.scale_px;
  int count = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Step& a = links[i];
      const Step& b = links[j];
      if (at_one_place(a, b, within_px) && !on_two_levels(a, b) && !cross(a, b)) ++count;
    }
  }
  return count;
}

}  // namespace flowdlo::path
