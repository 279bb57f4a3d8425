#include "path/doubles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/quantile.hpp"
#include "path/cut_ends.hpp"
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
constexpr float kShortest = 4.0F;     // widths; a flat crossing is shorter
constexpr float kShortestPx = 20.0F;  // what frays leave on thin ropes is shorter too
constexpr float kClearMean = 1.85F;   // what is this much wider in the mean
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
  Cutter(const Graph& graph, const image::Mask& mask, float width_px)
      : graph_(graph),
        mask_(mask),
        size_px_(width_px),
        narrowest_px_(width_px),
        ends_(graph, mask, width_px) {}

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
      ends_.clear = mean > kClearMean;
      if (length >= std::max(kShortest * width_px, kShortestPx) && mean < kMeanMost &&
          (mean > kMeanLeast ||
           (mean > kAslantLeast && anchored(segment, line, first, last - 1)))) {
        draw(segment, line, first, last - 1);
      }
      first = last;
    }
  }

  // The same for a stem between two forks, each with two branches narrower than the stem. Seen
  // aslant, two strands are not much wider than one; but four branches need two strands. So do two
  // at one fork, where the stem ends in a tip and they are the two ends of a loop.
  void cut_stem(std::size_t stem, const std::vector<Line>& lines) {
    const Segment& segment = graph_.segments[stem];
    const int tip = graph_.at_tip(segment, 0) ? 0 : 1;
    const bool looped = graph_.at_tip(segment, tip) && loops(stem, 1 - tip);
    if (!looped && (!graph_.forks(segment, 0) || !graph_.forks(segment, 1))) return;
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
    for (std::size_t i = trim; i + trim < line.size(); ++i) sizes.push_back(line[i].size_px);
    const float ratio = quantile(sizes, 0.5F) / branch_px;
    if (ratio < (looped ? kLoopedLeast : kForkedLeast) || ratio > kForkedMost) return;
    if (quantile(sizes, 0.85F) > kForkedSpread * quantile(sizes, 0.15F)) return;
    Cutter narrow(graph_, mask_, branch_px);
    narrow.ends_.clear = ratio > kClearMean;
    narrow.ends_.turns = !looped;
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
  // What comes before a stretch, seen from it, and what follows, as far as ends look.
  [[nodiscard]] std::pair<Line, Line> around(const Line& line, int first, int last) const {
    const int most = ends_.looks_px();
    const int count = static_cast<int>(line.size());
    Line before(line.begin() + std::max(0, first - most), line.begin() + first);
    std::reverse(before.begin(), before.end());
    return {std::move(before),
            Line(line.begin() + last + 1, line.begin() + std::min(count, last + 1 + most))};
  }

  // Whether both ends of a stretch show where a second strand comes or goes: a fork, or a step.
  [[nodiscard]] bool anchored(const Segment& segment, const Line& line, int first, int last) const {
    const float width_px = size_px_ * line[(first + last) / 2].nearer;
    const auto [before, after] = around(line, first, last);
    return (graph_.forks(segment, 0) || ends_.step(before, width_px) != nullptr) &&
           (graph_.forks(segment, 1) || ends_.step(after, width_px) != nullptr);
  }
  // Whether a fork's two other branches are the ends of one segment.
  [[nodiscard]] bool loops(std::size_t stem, int side) const {
    const Segment& segment = graph_.segments[stem];
    if (!graph_.forks(segment, side)) return false;
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
      sizes.push_back(station.size_px);
    }
  }

  void draw(const Segment& segment, const Line& line, int first, int last) {
    const float width_px = size_px_ * line[(first + last) / 2].nearer;
    Points points;
    for (int i = first; i <= last; ++i) points.push_back(line[i].middle_px);
    points = smoothed(std::move(points), std::max(1, static_cast<int>(0.5F * width_px)));
    const auto [before, after] = around(line, first, last);
    const bool back = ends_.find(points, segment, 1, after);
    std::reverse(points.begin(), points.end());
    const bool front = ends_.find(points, segment, 0, before);
    if (!back || !front) return;
    // A whole piece of the mask as wide as this is one rope.
    if (graph_.at_tip(segment, 0) && graph_.at_tip(segment, 1) && !ends_.step(before, width_px) &&
        !ends_.step(after, width_px)) {
      return;
    }
    found_.push_back(std::move(points));
  }

  const Graph& graph_;
  const image::Mask& mask_;
  float size_px_;
  float narrowest_px_;
  CutEnds ends_;
  std::vector<Points> found_;
};

}  // namespace

Doubles find_doubles(const Graph& graph, const Region& region, const Frame& frame) {
  const std::vector<Line> lines = stations_of(graph, region, frame);
  const float width_px = single_size(lines, graph.width_px);
  const bool told = width_px >= kLeastWidthPx;
  Cutter cutter(graph, region.mask, told ? width_px : graph.width_px);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t had = cutter.found().size();
    if (told) cutter.cut(graph.segments[i], lines[i]);
    if (cutter.found().size() == had && !lines[i].empty()) cutter.cut_stem(i, lines);
  }
  return {cutter.found(), cutter.strand_px()};
}

}  // namespace flowdlo::path
