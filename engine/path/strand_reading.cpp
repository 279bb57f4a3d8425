#include "path/strand_reading.hpp"

#include <cmath>
#include <vector>

#include "geometry/polyline.hpp"
#include "guard/guarded.hpp"
#include "path/midline.hpp"
#include "path/ranked.hpp"
#include "path/region.hpp"
#include "path/rope_paths.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

// A line in the coordinates of `region`, its points a pixel apart.
Stretch stretch_of(const field::AxisLine& line, const Region& region) {
  const Vector2f offset(static_cast<float>(region.offset_px.x),
                        static_cast<float>(region.offset_px.y));
  std::vector<Vector2f> points;
  points.reserve(line.points_px.size());
  for (const Vector2f& p : line.points_px) points.push_back(p - offset);
  const auto count = static_cast<int>(std::lround(length_of(points))) + 1;
  if (count >= 2) points = geometry::resample(points, count);
  return {std::move(points), line.tips, line.closed};
}

// The axes as strands of what `region` was cut out of.
Strands strands_of(const field::Axes& axes, const Region& region, const Frame& frame) {
  std::vector<Stretch> stretches;
  for (const field::AxisLine& line : axes.lines) stretches.push_back(stretch_of(line, region));
  return make_strands(stretches, axes.width_px, region, frame);
}

}  // namespace

Result<Traversals> trace_strands(const Frame& frame, const field::Axes& axes,
                                 const TraceConfig& config) {
  return guard::guarded("path", [&]() -> Result<Traversals> {
    const auto region = clean(frame);
    if (!region) return region.error();
    return rank(strands_of(axes, *region, frame), *region, frame, config);
  });
}

Result<RopePaths> trace_ropes(const Frame& frame, const field::Axes& axes, int ropes) {
  return guard::guarded("path", [&]() -> Result<RopePaths> {
    const auto region = clean(frame, ropes);
    if (!region) return region.error();
    return rope_paths(strands_of(axes, *region, frame), *region, frame, ropes);
  });
}

}  // namespace flowdlo::path
