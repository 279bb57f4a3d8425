#include "path/strand_reading.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/polyline.hpp"
#include "guard/guarded.hpp"
#include "path/links.hpp"
#include "path/midline.hpp"
#include "path/ranked.hpp"
#include "path/region.hpp"
#include "path/rope_paths.hpp"
#include "path/strands.hpp"
#include "path/window.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kTip = 0.3F;         // of an end that is its rope's
constexpr float kJoinWidths = 1.0F;  // from half a width ahead of an end to what it runs into
constexpr float kGrazing = 0.6F;     // cosine of the angle between them

// A line in the coordinates of `region`, its points a pixel apart.
Stretch stretch_of(const field::AxisLine& line, const Region& region) {
  const Vector2f offset = offset_of(region);
  std::vector<Vector2f> points;
  points.reserve(line.points_px.size());
  for (const Vector2f& p : line.points_px) points.push_back(p - offset);
  const auto count = static_cast<int>(std::lround(length_of(points))) + 1;
  if (count >= 2) points = geometry::resample(points, count);
  return {std::move(points), line.tips, line.closed};
}

std::vector<Stretch> stretches_of(const field::Axes& axes, const Region& region) {
  std::vector<Stretch> stretches;
  for (const field::AxisLine& line : axes.lines) stretches.push_back(stretch_of(line, region));
  return stretches;
}

// A place of a stretch.
struct Place {
  std::size_t stretch = 0;
  std::size_t point = 0;
};

// The place of `points`, away from their ends by `apart` at least, that is nearest to `p` and
// within `most_px` of it; those for which `skipped` is true do not count.
template <class Skipped>
std::optional<std::size_t> nearest_within(const Points& points, std::size_t apart,
                                          const Vector2f& p, float most_px,
                                          const Skipped& skipped) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = apart; i + apart < points.size(); ++i) {
    if (skipped(i)) continue;
    const float away = (points[i] - p).norm();
    if (away >= most_px) continue;
    most_px = away;
    nearest = i;
  }
  return nearest;
}

// Where the ends of stretches that are no tips run into others, or into far parts of their own, all
// but along them.
std::vector<Place> joins(const std::vector<Stretch>& stretches, float width_px) {
  const auto arm = static_cast<std::size_t>(std::max(2.0F, width_px));
  const auto along = [&](const Points& points, std::size_t i) {
    const std::size_t last = points.size() - 1;
    return Vector2f(points[std::min(i + arm, last)] - points[i < arm ? 0 : i - arm]).normalized();
  };
  std::vector<Place> found;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const Points& own = stretches[s].points_px;
    for (const std::size_t side : {0, 1}) {
      if (stretches[s].closed || stretches[s].tips[side] >= kTip || own.size() <= arm) continue;
      const std::size_t end = side == 0 ? 0 : own.size() - 1;
      const Vector2f in = side == 0 ? own[arm] : own[end - arm];
      const Vector2f out = (own[end] - in).normalized();
      const Vector2f ahead = own[end] + 0.5F * width_px * out;
      for (std::size_t t = 0; t < stretches.size(); ++t) {
        if (stretches[t].closed) continue;
        const Points& other = stretches[t].points_px;
        const auto nearest = nearest_within(
            other, 2 * arm, ahead, kJoinWidths * width_px,
            [&](std::size_t i) { return t == s && (i > end ? i - end : end - i) < 4 * arm; });
        if (!nearest) continue;
        if (std::abs(along(other, *nearest).dot(out)) > kGrazing) found.push_back({t, *nearest});
      }
    }
  }
  return found;
}

// Two strands that cross flatly look like one that goes on, and one that ends: which is which is
// for the search. So a stretch is cut wherever another one's end runs into it flatly, without half
// a width to either side, which bends from the one to the other.
std::vector<Stretch> cut_at_joins(const std::vector<Stretch>& stretches, float width_px) {
  std::vector<std::vector<std::size_t>> cuts(stretches.size());
  for (const Place& place : joins(stretches, width_px)) {
    cuts[place.stretch].push_back(place.point);
  }
  const auto least = static_cast<std::size_t>(std::max(2.0F, width_px));
  const std::size_t half = least / 2;
  std::vector<Stretch> result;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const Points& points = stretches[s].points_px;
    std::sort(cuts[s].begin(), cuts[s].end());
    std::size_t first = 0;
    for (const std::size_t cut : cuts[s]) {
      if (cut < first + half + least) continue;
      Stretch& part = result.emplace_back();
      part.points_px.assign(points.begin() + static_cast<std::ptrdiff_t>(first),
                            points.begin() + static_cast<std::ptrdiff_t>(cut - half));
      part.tips[0] = first == 0 ? stretches[s].tips[0] : 0;
      first = cut + half;
    }
    Stretch& rest = result.emplace_back(stretches[s]);
    rest.points_px.erase(rest.points_px.begin(),
                         rest.points_px.begin() + static_cast<std::ptrdiff_t>(first));
    if (first > 0) rest.tips[0] = 0;
  }
  return result;
}

// How much each end that is no tip yet looks like one.
void see_tips(std::vector<Stretch>& stretches, const field::Axes& axes, const Region& region) {
  const Vector2f offset = offset_of(region);
  for (Stretch& stretch : stretches) {
    if (stretch.closed) continue;
    for (float& tip : stretch.tips) {
      const Vector2f out = direction_at_front(stretch.points_px, axes.width_px);
      tip = std::max(tip, axes.view.tip_ahead(stretch.points_px.front() + offset, out));
      std::reverse(stretch.points_px.begin(), stretch.points_px.end());
    }
  }
}

// The axes of a frame in a copy of it.
field::Axes axes_in(const Reduced& copy, field::Axes axes) {
  axes.width_px *= copy.scale();
  for (field::AxisLine& line : axes.lines) {
    for (Vector2f& p : line.points_px) p = copy.place_of(p);
  }
  axes.view = axes.view.from_copy(copy.place_of({0, 0}), copy.scale());
  return axes;
}

// Guesses of a frame in a copy of it.
std::vector<RopesGuess> guesses_in(const Reduced& copy, std::vector<RopesGuess> guesses) {
  for (RopesGuess& guess : guesses) guess.ropes = copy.paths_in(std::move(guess.ropes));
  return guesses;
}

// What `trace` makes of the frame and its axes, or of a reduced copy of both.
template <class Answer, class Trace>
Result<Answer> trace_axes(const Frame& frame, const field::Axes& axes, const Trace& trace) {
  return guard::guarded("path", [&]() -> Result<Answer> {
    return trace_reduced<Answer>(frame, [&](const Frame& seen, const Reduced* copy) {
      return copy == nullptr ? trace(seen, axes, copy) : trace(seen, axes_in(*copy, axes), copy);
    });
  });
}

}  // namespace

Strands strands_of(const Frame& frame, const field::Axes& axes, const Region& region,
                   bool several) {
  auto stretches = cut_at_joins(stretches_of(axes, region), axes.width_px);
  see_tips(stretches, axes, region);
  Strands strands = make_strands(stretches, axes.width_px, region, frame, axes.view);
  strands.several = several;
  strands.links = axes.links.get();
  return strands;
}

Result<Traversals> trace_strands(const Frame& frame, const field::Axes& axes,
                                 const TraceConfig& config) {
  const auto trace = [&](const Frame& seen, const field::Axes& lines,
                         const Reduced* copy) -> Result<Traversals> {
    const bool known = copy == nullptr && config.cleaned != nullptr;
    const auto region = known ? Result<Region>(*config.cleaned) : clean(seen);
    if (!region) return region.error();
    return rank(strands_of(seen, lines, *region), *region, seen, config);
  };
  return trace_axes<Traversals>(frame, axes, trace);
}

Result<RopePaths> trace_ropes(const Frame& frame, const field::Axes& axes, int ropes,
                              const std::vector<RopesGuess>& guesses,
                              const std::vector<Path>& before) {
  const auto trace = [&](const Frame& seen, const field::Axes& lines,
                         const Reduced* copy) -> Result<RopePaths> {
    const auto region = clean(seen, ropes);
    if (!region) return region.error();
    const Strands strands = strands_of(seen, lines, *region, ropes != 1);
    const Opinion opinion =
        opinion_on(strands, copy == nullptr ? guesses : guesses_in(*copy, guesses), *region);
    return rope_paths(strands, prices_of(strands, *region, seen, opinion), *region, seen,
                      {ropes, copy == nullptr ? before : copy->paths_in(before)});
  };
  return trace_axes<RopePaths>(frame, axes, trace);
}

}  // namespace flowdlo::path
