#include "path/cut_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "path/region.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kTrimWidths = 0.3F;     // what a round tip takes from the stretch
constexpr float kTangentWidths = 3.0F;  // what tells the direction at its end
constexpr float kRunOutWidths = 2.5F;   // from there to where the strands part,
constexpr float kPartWidths = 12.0F;    // from a fork on
constexpr float kLoopedWidths = 8.0F;   // or where both are ends of one loop
constexpr float kStepWidths = 2.0F;     // within this way two strands become one
constexpr float kStepKept = 1.5F;       // and stay one for this long,
constexpr float kSingleLeast = 0.75F;   // this wide at least
constexpr float kSingleMost = 1.18F;    // and at most
constexpr float kPixelNoise = 0.8F;     // and a thin one this many pixels more, beside
constexpr std::array<float, 3> kFitWidths{1.5F, 2.5F, 4.0F};  // of a line beside a step,
constexpr float kBlurWidths = 0.5F;                           // beyond what blurs it
constexpr float kSureSigmas = 2.0F;                           // and believed from this on
constexpr float kStepLeast = 0.1F;    // aside from the line the one lies at least this far
constexpr float kTurnWidths = 1.0F;   // a strand that turns back takes this at the tip
constexpr float kCornerDeep = 0.25F;  // so far before the edge a mask cut off
constexpr float kCornerAside = 0.8F;  // reaches so far aside, a round one does not

// Where `points`, bending on as they do, come nearest to `p`.
Vector2f ahead(const Points& points, const Vector2f& p, float width_px) {
  const std::size_t last = points.size() - 1;
  const auto half = static_cast<std::size_t>(std::max(2.0F, 0.5F * kTangentWidths * width_px));
  const Vector2f& from = points[last];
  const Vector2f& middle = points[last - std::min(half, last / 2)];
  const Vector2f& start = points[last - 2 * std::min(half, last / 2)];
  const float step = std::max(1e-3F, (from - middle).norm());
  const float t = (p - from).dot(from - middle) / (step * step);
  return from + t * (from - middle) + 0.5F * t * (t + 1) * (from - 2 * middle + start);
}

}  // namespace

int CutEnds::looks_px() const {
  const float widths = kStepWidths + kStepKept + kBlurWidths + kFitWidths.back();
  return static_cast<int>(std::ceil(widths * kNearerMost * size_px_)) + 8;
}

bool CutEnds::single(const Station& station) const {
  const float widths = station.size_px / size_px_;
  const float most = clear ? std::max(kSingleMost, 1 + kPixelNoise / size_px_) : kSingleMost;
  return station.whole && widths > kSingleLeast && widths < most;
}

const Station* CutEnds::step(const Line& after, float width_px) const {
  const auto reach_px = static_cast<std::size_t>(kStepWidths * width_px) + 1;
  const auto kept = static_cast<std::size_t>(kStepKept * width_px);
  for (std::size_t i = 0; i < reach_px && i + kept < after.size(); ++i) {
    if (single(after[i]) && single(after[i + kept / 2]) && single(after[i + kept])) {
      return &after[i + kept / 8];
    }
  }
  return nullptr;
}

// Whether the mask ends at `edge` as round as a strand that turns back.
bool CutEnds::round(const Vector2f& edge, const Vector2f& direction, float width_px) const {
  const Vector2f at = edge - kCornerDeep * width_px * direction;
  const Vector2f left(-direction.y(), direction.x());
  return !lit(mask_, at + kCornerAside * width_px * left) &&
         !lit(mask_, at - kCornerAside * width_px * left);
}

// How far to the left of the back of `points` the line lies that goes on from `station`. The
// shorter lines are fitted the less they bend, the longer the less noise tells. 0: unknown.
float CutEnds::aside_at(const Points& points, const Line& after, const Station& station,
                        const Vector2f& left, float width_px) const {
  const auto skip = static_cast<std::size_t>(kBlurWidths * width_px);
  const auto from = static_cast<std::size_t>(&station - after.data()) + skip;
  float best_px = left.dot(station.middle_px - ahead(points, station.middle_px, width_px));
  if (std::abs(best_px) < kStepLeast * width_px) best_px = 0;
  float surest = kSureSigmas;
  for (const float widths : kFitWidths) {
    const auto most = static_cast<std::size_t>(widths * width_px) + 4;
    Points before;
    for (std::size_t i = skip; i < std::min(skip + most, points.size()); ++i) {
      before.push_back(points[points.size() - 1 - i]);
    }
    Points behind;
    for (std::size_t i = from; i < std::min(from + most, after.size()); ++i) {
      if (!single(after[i])) break;
      behind.push_back(after[i].middle_px);
    }
    const Aside aside = step_aside(before, behind, left);
    if (aside.sigma_px <= 0 || std::abs(aside.px) > width_px) continue;
    const float sure = std::abs(aside.px) / aside.sigma_px;
    if (sure > surest) {
      surest = sure;
      best_px = aside.px;
    }
  }
  return best_px;
}

bool CutEnds::beside_step(Points& points, const Line& after, const Station& station,
                          const Vector2f& direction, float width_px) const {
  const Vector2f left(-direction.y(), direction.x());
  const float aside = aside_at(points, after, station, left, width_px);
  if (aside == 0) return false;
  const float side = (station.normal.dot(left) > 0) == (aside < 0) ? 1.0F : -1.0F;
  const Vector2f corner = station.edge(side);
  points.push_back(corner + (corner - station.middle_px).normalized());
  return true;
}

bool CutEnds::at_edge(Points& points, const Line& after, bool tip) const {
  const float nearer = after.empty() ? 1 : after.front().nearer;
  const float width_px = size_px_ * nearer;
  const auto trim = static_cast<std::size_t>(kTrimWidths * width_px);
  if (points.size() < trim + 4) return false;
  points.resize(points.size() - trim);
  const auto back = std::min(points.size() - 1,
                             static_cast<std::size_t>(std::max(4.0F, kTangentWidths * width_px)));
  const Vector2f along = points.back() - points[points.size() - 1 - back];
  if (along.norm() <= 0) return false;
  const Vector2f direction = along.normalized();
  const Vector2f from = points.back();
  if (const Station* station = step(after, width_px)) {
    return beside_step(points, after, *station, direction, width_px);
  }
  const float most = (tip && !turns ? kLoopedWidths : kRunOutWidths) * width_px + 2;
  const float to_edge = reach(mask_, from, direction, most);
  if (to_edge + kScanStepPx >= most) return false;
  if (!tip || !turns || !round(from + to_edge * direction, direction, width_px)) {
    points.push_back(from + (to_edge + 1) * direction);
    return true;
  }
  const Vector2f edge = from + to_edge * direction;
  while (points.size() > 1 && (points.back() - edge).norm() < kTurnWidths * width_px) {
    points.pop_back();
  }
  return points.size() > 1;
}

// The point `i` steps from an end of a segment; before its middle, where it ends in no tip; null
// beyond.
const Vector2f* CutEnds::along_branch(int end, std::size_t i) const {
  const Segment& branch = graph_.segments[static_cast<std::size_t>(end / 2)];
  const Points& points = branch.points_px;
  const std::size_t steps = graph_.at_tip(branch, 1 - end % 2) ? i : 2 * i;
  if (steps >= points.size()) return nullptr;
  return end % 2 == 0 ? &points[i] : &points[points.size() - 1 - i];
}

// Where the two branches of the segment's fork part: midway between
// them from the fork on, to the first point that is no mask. False when there is none near.
bool CutEnds::between_branches(Points& points, const Segment& segment, int side) const {
  if (!graph_.forks(segment, side)) return false;
  const Node& node = graph_.nodes[static_cast<std::size_t>(segment.node[side])];
  std::vector<int> ends;
  for (const int end : node.ends) {
    const Segment& branch = graph_.segments[static_cast<std::size_t>(end / 2)];
    if (&branch != &segment) ends.push_back(end);
  }
  const float near_px = kRunOutWidths * size_px_ + 2;
  if (ends.size() != 2 || (points.back() - node.position_px).norm() > near_px) return false;
  Points on = points;
  on.push_back(node.position_px);
  const auto most = static_cast<std::size_t>(kPartWidths * size_px_) + 2;
  for (std::size_t i = 1; i < most; ++i) {
    const Vector2f* a = along_branch(ends[0], i);
    const Vector2f* b = along_branch(ends[1], i);
    if (a == nullptr || b == nullptr) return false;
    on.push_back(0.5F * (*a + *b));
    if (lit(mask_, on.back())) continue;
    points = std::move(on);
    return true;
  }
  return false;
}

bool CutEnds::find(Points& points, const Segment& segment, int side, const Line& after) const {
  return at_edge(points, after, graph_.at_tip(segment, side)) ||
         between_branches(points, segment, side);
}

}  // namespace flowdlo::path
