#include "path/doubles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "geometry/quantile.hpp"
#include "path/midline.hpp"
#include "path/stations.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using geometry::quantile;
using Points = std::vector<Vector2f>;

constexpr float kDoubleLeast = 1.25F;  // widths: two strands from this
constexpr float kDoubleMost = 2.7F;    // to this
constexpr float kMeanLeast = 1.52F;    // in the mean;
constexpr float kAslantLeast = 1.33F;  // seen aslant, one partly hides the other: between forks
constexpr float kMeanMost = 2.4F;
constexpr float kShortest = 4.0F;  // widths; a flat crossing is shorter
constexpr float kShortestStepped = 2.0F;
constexpr float kShortestPx = 20.0F;    // what frays leave on thin ropes is shorter too
constexpr float kTrimWidths = 0.3F;     // what a round tip takes from the stretch
constexpr float kTangentWidths = 3.0F;  // what tells the direction at its end
constexpr float kRunOutWidths = 2.5F;   // from there to where the strands part,
constexpr float kPartWidths = 12.0F;    // from a fork on,
constexpr float kCutOffWidths = 8.0F;   // or an occluder aslant hides both
constexpr float kStepWidths = 2.0F;     // within this way two strands become one
constexpr float kStepKept = 1.5F;       // and stay one for this long,
constexpr float kSingleLeast = 0.75F;   // this wide at least
constexpr float kSingleMost = 1.18F;    // and at most
constexpr float kPixelNoise = 0.8F;     // and a thin one this many pixels more, beside
constexpr float kClearMean = 1.85F;     // what is this much wider in the mean
constexpr std::array<float, 3> kFitWidths{1.5F, 2.5F, 4.0F};  // of a line beside a step,
constexpr float kBlurWidths = 0.5F;                           // beyond what blurs it
constexpr float kSureSigmas = 2.0F;                           // and believed from this on
constexpr float kStepLeast = 0.1F;    // aside from the line the one lies at least this far
constexpr float kTurnWidths = 1.0F;   // a strand that turns back takes this at the tip
constexpr float kCornerDeep = 0.25F;  // so far before the edge a mask cut off
constexpr float kCornerAside = 0.8F;  // reaches so far aside, a round one does not
constexpr float kStandsSeamPx = 8.0F;
constexpr float kLeastWidthPx = 1.5F;
constexpr float kForkedLeast = 1.18F;  // times its branches' width: a stem of two strands
constexpr float kLoopedLeast = 1.3F;
constexpr float kForkedMost = 2.7F;
constexpr float kForkedSpread = 1.35F;  // and even
constexpr float kBranchFrom = 1.0F;     // branches tell from this many widths off the fork
constexpr float kBranchTo = 8.0F;       // to this many
constexpr std::size_t kFewestStations = 4;

class Cutter {
 public:
  Cutter(const Graph& graph, const cv::Mat& mask, float width_px)
      : graph_(graph), mask_(mask), size_px_(width_px), narrowest_px_(width_px) {}

  // To cut nothing but what is too wide for one strand whatever its noise.
  void only_clear() { least_ = kClearMean; }

  void cut(const Segment& segment, const Line& line) {
    const int count = static_cast<int>(line.size());
    for (int first = 0; first < count; ++first) {
      if (!wide(line[first])) continue;
      int last = first;
      float sum = 0;
      for (; last < count && goes_on(line, last); ++last) sum += widths(line[last]);
      const auto length = static_cast<float>(last - first);
      const float mean = sum / length;
      const float width_px = size_px_ * line[(first + last) / 2].nearer;
      clear_ = mean > kClearMean;
      const bool brief = mean > kMeanLeast && stepped(line, first, last - 1);
      const float shortest = (brief ? kShortestStepped : kShortest) * width_px;
      if (length >= std::max(shortest, kShortestPx) && mean < kMeanMost &&
          (mean > std::max(kMeanLeast, least_) ||
           (mean > std::max(kAslantLeast, least_) && anchored(segment, line, first, last - 1)))) {
        draw(segment, line, first, last - 1);
      }
      first = last;
    }
  }

  // The same for a stem between two forks, each with two branches narrower than the stem. Seen
  // aslant, two strands are not much wider than one; but four branches need two strands. So do two
  // at one fork, where the stem ends in a tip and they are the two ends of a loop.
  void cut_stem(std::size_t stem, const std::vector<Line>& lines) {
    if (least_ > 0) return;
    const Segment& segment = graph_.segments[stem];
    const int tip = at_tip(segment, 0) ? 0 : 1;
    const bool looped = at_tip(segment, tip) && loops(stem, 1 - tip);
    if (!looped && (!forks(segment, 0) || !forks(segment, 1))) return;
    std::vector<float> branches;
    for (const int node : segment.node) {
      const std::size_t before = branches.size();
      if (looped && node == segment.node[tip]) continue;
      for (const int end : graph_.nodes[static_cast<std::size_t>(node)].ends) {
        if (static_cast<std::size_t>(end / 2) != stem) gather(lines, end, branches);
      }
      if (branches.size() < before + kFewestStations) return;
    }
    const float branch_px = quantile(branches, 0.5F);
    const Line& line = lines[stem];
    const auto trim = static_cast<std::size_t>(kBranchFrom * branch_px) + 1;
    const float shortest = std::max(kShortest * branch_px, kShortestPx);
    if (static_cast<float>(line.size()) < shortest + 2 * static_cast<float>(trim)) return;
    std::vector<float> sizes;
    for (std::size_t i = trim; i + trim < line.size(); ++i) {
      if (line[i].seamed) return;
      sizes.push_back(line[i].size_px);
    }
    const float ratio = quantile(sizes, 0.5F) / branch_px;
    if (ratio < (looped ? kLoopedLeast : kForkedLeast) || ratio > kForkedMost) return;
    if (quantile(sizes, 0.85F) > kForkedSpread * quantile(sizes, 0.15F)) return;
    Cutter narrow(graph_, mask_, branch_px);
    narrow.clear_ = ratio > kClearMean;
    narrow.turns_ = !looped;
    narrow.draw(segment, line, static_cast<int>(trim), static_cast<int>(line.size() - trim) - 1);
    if (narrow.found_.empty()) return;
    found_.push_back(std::move(narrow.found_.front()));
    narrowest_px_ = std::min(narrowest_px_, branch_px);
  }

  [[nodiscard]] const std::vector<Points>& found() const { return found_; }
  // Of one strand: what was told, or the narrowest branch of a stem that was cut.
  [[nodiscard]] float strand_px() const { return narrowest_px_; }

 private:
  [[nodiscard]] float widths(const Station& station) const { return station.size_px / size_px_; }
  [[nodiscard]] bool wide(const Station& station) const {
    return widths(station) > kDoubleLeast && widths(station) < kDoubleMost;
  }
  // Wide at `i`, or wider still for no longer than a strand is wide.
  [[nodiscard]] bool goes_on(const Line& line, int i) const {
    const int count = static_cast<int>(line.size());
    const int most = i + static_cast<int>(size_px_) + 1;
    for (; i < std::min(count, most) && widths(line[i]) >= kDoubleMost; ++i) {
    }
    return i < count && wide(line[i]);
  }
  [[nodiscard]] bool single(const Station& station) const {
    const float most = clear_ ? std::max(kSingleMost, 1 + kPixelNoise / size_px_) : kSingleMost;
    return station.whole && widths(station) > kSingleLeast && widths(station) < most;
  }
  [[nodiscard]] bool at_tip(const Segment& segment, int side) const {
    return !segment.ring() && graph_.nodes[segment.node[side]].ends.size() == 1;
  }

  // What comes before a stretch, seen from it, and what follows.
  static std::pair<Line, Line> around(const Line& line, int first, int last) {
    Line before(line.begin(), line.begin() + first);
    std::reverse(before.begin(), before.end());
    return {std::move(before), Line(line.begin() + last + 1, line.end())};
  }

  // Whether one of the two strands stops at an end of a stretch: a crossing does not look so.
  [[nodiscard]] bool stepped(const Line& line, int first, int last) const {
    const float width_px = size_px_ * line[(first + last) / 2].nearer;
    const auto [before, after] = around(line, first, last);
    return step(before, width_px) != nullptr || step(after, width_px) != nullptr;
  }

  // Whether both ends of a stretch show where a second strand comes or goes: a fork, or a step.
  [[nodiscard]] bool anchored(const Segment& segment, const Line& line, int first, int last) const {
    const float width_px = size_px_ * line[(first + last) / 2].nearer;
    const auto [before, after] = around(line, first, last);
    return (forks(segment, 0) || step(before, width_px) != nullptr) &&
           (forks(segment, 1) || step(after, width_px) != nullptr);
  }
  [[nodiscard]] bool forks(const Segment& segment, int side) const {
    return !segment.ring() && graph_.nodes[segment.node[side]].ends.size() > 2;
  }

  // Whether a fork's two other branches are the ends of one segment.
  [[nodiscard]] bool loops(std::size_t stem, int side) const {
    const Segment& segment = graph_.segments[stem];
    if (!forks(segment, side)) return false;
    std::vector<int> others;
    for (const int end : graph_.nodes[static_cast<std::size_t>(segment.node[side])].ends) {
      if (static_cast<std::size_t>(end / 2) != stem) others.push_back(end / 2);
    }
    return others.size() == 2 && others[0] == others[1];
  }

  // The sizes near a segment's end; 2 * segment + side.
  static void gather(const std::vector<Line>& lines, int end, std::vector<float>& sizes) {
    const Line& line = lines[static_cast<std::size_t>(end / 2)];
    if (line.empty()) return;
    const float width_px = std::max(1.0F, line[line.size() / 2].size_px);
    const auto from = static_cast<std::size_t>(kBranchFrom * width_px) + 1;
    const auto to = std::min(line.size(), static_cast<std::size_t>(kBranchTo * width_px) + 1);
    for (std::size_t i = from; i < to; ++i) {
      const Station& station = end % 2 == 0 ? line[i] : line[line.size() - 1 - i];
      if (!station.seamed) sizes.push_back(station.size_px);
    }
  }

  void draw(const Segment& segment, const Line& line, int first, int last) {
    const float width_px = size_px_ * line[(first + last) / 2].nearer;
    Points points;
    for (int i = first; i <= last; ++i) points.push_back(line[i].middle_px);
    points = smoothed(std::move(points), std::max(1, static_cast<int>(0.5F * width_px)));
    const auto [before, after] = around(line, first, last);
    const bool e1 = end_at(points, after, at_tip(segment, 1)) || part_at(points, segment, 1);
    std::reverse(points.begin(), points.end());
    const bool e2 = end_at(points, before, at_tip(segment, 0)) || part_at(points, segment, 0);
    if (!e1 || !e2) return;
    // A whole piece of the mask as wide as this is one rope.
    if (at_tip(segment, 0) && at_tip(segment, 1) && !step(before, width_px) &&
        !step(after, width_px)) {
      return;
    }
    found_.push_back(std::move(points));
  }

  // Ends the line at its back, where the strands part: at the mask's edge between them, or beside
  // the step where one stops, or, where both turn into each other, a width short of the tip. False
  // when none of these is near. `after` is what follows on the line.
  [[nodiscard]] bool end_at(Points& points, const Line& after, bool tip) const {
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
      const Vector2f left(-direction.y(), direction.x());
      const float aside = aside_at(points, after, *station, left, width_px);
      if (aside == 0) return false;
      const float side = (station->normal.dot(left) > 0) == (aside < 0) ? 1.0F : -1.0F;
      const Vector2f corner = station->edge(side);
      points.push_back(corner + (corner - station->middle_px).normalized());
      return true;
    }
    const bool cut_off = tip && !after.empty() && !after.front().whole;
    const bool far = cut_off || (tip && !turns_);
    const float most = (far ? kCutOffWidths : kRunOutWidths) * width_px + 2;
    const float to_edge = reach(mask_, from, direction, most);
    if (to_edge + kScanStepPx >= most) return false;
    if (!tip || !turns_ || !round(from + to_edge * direction, direction, width_px)) {
      points.push_back(from + (to_edge + 1) * direction);
      return true;
    }
    const Vector2f edge = from + to_edge * direction;
    while (points.size() > 1 && (points.back() - edge).norm() < kTurnWidths * width_px) {
      points.pop_back();
    }
    return points.size() > 1;
  }

  // Ends the line at its back where the two branches of the segment's fork part: midway between
  // them from the fork on, to the first point that is no mask. False when there is none near.
  [[nodiscard]] bool part_at(Points& points, const Segment& segment, int side) const {
    if (!forks(segment, side)) return false;
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

  // The point `i` steps from an end of a segment; before its middle, where it ends in no tip; null
  // beyond.
  [[nodiscard]] const Vector2f* along_branch(int end, std::size_t i) const {
    const Segment& branch = graph_.segments[static_cast<std::size_t>(end / 2)];
    const Points& points = branch.points_px;
    const std::size_t steps = at_tip(branch, 1 - end % 2) ? i : 2 * i;
    if (steps >= points.size()) return nullptr;
    return end % 2 == 0 ? &points[i] : &points[points.size() - 1 - i];
  }

  // How far to the left of the back of `points` the line lies that goes on from `station`. The
  // shorter lines are fitted the less they bend, the longer the less noise tells. 0: unknown.
  [[nodiscard]] float aside_at(const Points& points, const Line& after, const Station& station,
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

  // Where `points`, bending on as they do, come nearest to `p`.
  static Vector2f ahead(const Points& points, const Vector2f& p, float width_px) {
    const std::size_t last = points.size() - 1;
    const auto half = static_cast<std::size_t>(std::max(2.0F, 0.5F * kTangentWidths * width_px));
    const Vector2f& from = points[last];
    const Vector2f& middle = points[last - std::min(half, last / 2)];
    const Vector2f& start = points[last - 2 * std::min(half, last / 2)];
    const float step = std::max(1e-3F, (from - middle).norm());
    const float t = (p - from).dot(from - middle) / (step * step);
    return from + t * (from - middle) + 0.5F * t * (t + 1) * (from - 2 * middle + start);
  }

  // Where the line goes on as one strand, soon and for long enough; null where it does not.
  [[nodiscard]] const Station* step(const Line& after, float width_px) const {
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
  [[nodiscard]] bool round(const Vector2f& edge, const Vector2f& direction, float width_px) const {
    const Vector2f at = edge - kCornerDeep * width_px * direction;
    const Vector2f left(-direction.y(), direction.x());
    return !lit(mask_, at + kCornerAside * width_px * left) &&
           !lit(mask_, at - kCornerAside * width_px * left);
  }

  const Graph& graph_;
  const cv::Mat& mask_;
  float size_px_;
  float narrowest_px_;
  float least_ = 0;     // widths: nothing narrower is cut
  bool turns_ = true;   // a strand may turn back at a round tip
  bool clear_ = false;  // the stretch at hand is too wide for one strand whatever its noise
  std::vector<Points> found_;
};

}  // namespace

Doubles find_doubles(const Graph& graph, const Region& region, const Frame& frame) {
  const std::vector<Line> lines = stations_of(graph, region, frame);
  const float width_px = single_size(lines, graph.width_px);
  const bool told = width_px >= kLeastWidthPx;
  Cutter cutter(graph, region.mask, told ? width_px : graph.width_px);
  // Where the depth told strands apart, thin ones are narrower now than they are.
  if (!region.seams.empty() && graph.width_px < kStandsSeamPx) cutter.only_clear();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t had = cutter.found().size();
    if (told) cutter.cut(graph.segments[i], lines[i]);
    if (cutter.found().size() == had && !lines[i].empty()) cutter.cut_stem(i, lines);
  }
  return {cutter.found(), cutter.strand_px()};
}

}  // namespace flowdlo::path
