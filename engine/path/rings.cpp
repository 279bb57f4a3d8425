#include "path/rings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/quantile.hpp"
#include "path/midline.hpp"
#include "path/stations.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using geometry::quantile;
using Points = std::vector<Vector2f>;

constexpr int kLeastPoints = 24;
constexpr int kUsualSamples = 64;       // of a third of the ring, which tells what is usual
constexpr float kBesideLeast = 1.2F;    // usual widths: two ends beside each other
constexpr float kBesideMost = 2.4F;     // are this wide in the mean
constexpr float kBesideWidths = 1.0F;   // for so long at least
constexpr float kBesideExcess = 0.55F;  // square widths more than one strand takes
constexpr float kBesideClear = 2.2F;    // times what frays add elsewhere
constexpr float kNotchLeast = 0.10F;    // how much narrower a notch is, in usual widths,
constexpr float kNotchClear = 1.1F;     // times the deepest elsewhere;
constexpr float kNotchOfEnds = 0.3F;    // this deep it is two round ends, and no fray of the border
constexpr float kFitWidths = 4.0F;      // of a line to each side of a step
constexpr float kTipWidths = 0.4F;      // where a tip's middle line ends
constexpr float kStepWidths = 0.6F;     // about which it is blurred
constexpr float kAsideLeast = 0.12F;    // widths: what tells the side that an end lies on

// Across a ring, at each of its points; indices wrap around.
class Ring {
 public:
  Ring(const Points& points, const image::Mask& mask, float usual_px)
      : count_(static_cast<int>(points.size())) {
    const int half = std::clamp(static_cast<int>(std::lround(0.5F * usual_px)), 2, 12);
    for (int i = 0; i < count_; ++i) points_.push_back(mean_at(points, i, half));
    const float most = kMostScan * usual_px + 2;
    for (int i = 0; i < count_; ++i) {
      const Vector2f along = points_[wrap(i + half)] - points_[wrap(i - half)];
      stations_.push_back(across(mask, points_[i], along, most));
      widths_.push_back(stations_.back().width_px);
    }
    size_px_ = quantile(widths_, 0.5F);
    for (int i = 0; i < count_; ++i) usual_.push_back(usual_around(i));
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int wrap(int i) const { return ((i % count_) + count_) % count_; }
  [[nodiscard]] float size_px() const { return size_px_; }
  [[nodiscard]] const Vector2f& point(int i) const { return points_[wrap(i)]; }
  [[nodiscard]] const Vector2f& middle(int i) const { return stations_[wrap(i)].middle_px; }
  [[nodiscard]] const Vector2f& normal(int i) const { return stations_[wrap(i)].normal; }
  [[nodiscard]] float usual_px(int i) const { return usual_[wrap(i)]; }
  // In usual widths, the median over 2 `half` + 1 points.
  [[nodiscard]] float width(int i, int half) const {
    std::vector<float> window;
    for (int k = i - half; k <= i + half; ++k) window.push_back(widths_[wrap(k)]);
    return quantile(std::move(window), 0.5F) / usual_[wrap(i)];
  }
  [[nodiscard]] float mean_width(int i, int half) const {
    float sum = 0;
    for (int k = i - half; k <= i + half; ++k) sum += widths_[wrap(k)];
    return sum / (static_cast<float>(2 * half + 1) * usual_[wrap(i)]);
  }

 private:
  [[nodiscard]] Vector2f mean_at(const Points& points, int i, int half) const {
    Vector2f sum{0, 0};
    for (int k = i - half; k <= i + half; ++k) sum += points[wrap(k)];
    return sum / static_cast<float>(2 * half + 1);
  }
  [[nodiscard]] float usual_around(int i) const {
    std::vector<float> window;
    const int step = std::max(1, count_ / (3 * kUsualSamples));
    for (int k = i - count_ / 6; k <= i + count_ / 6; k += step) {
      window.push_back(widths_[wrap(k)]);
    }
    return std::max(1.0F, quantile(std::move(window), 0.5F));
  }

  int count_;
  Points points_;  // smoothed
  Line stations_;
  std::vector<float> widths_;
  std::vector<float> usual_;
  float size_px_ = 1;
};

// Where two ends lie beside each other: points `first` to `last`, which may lie past the count.
struct Beside {
  int first = 0;
  int last = 0;
  float excess = 0;  // square widths
};

std::optional<Beside> ends_beside(const Ring& ring) {
  const int count = ring.count();
  const int half = std::max(1, static_cast<int>(0.4F * ring.size_px()));
  std::vector<float> width;
  for (int i = 0; i < count; ++i) width.push_back(ring.width(i, half));
  const auto wide = [&](int i) { return width[ring.wrap(i)] > kBesideLeast; };
  int start = 0;
  while (start < count && wide(start)) ++start;
  if (start == count) return std::nullopt;
  Beside best;
  float second = 0;
  for (int i = start; i < start + count; ++i) {
    if (!wide(i)) continue;
    Beside run{i, i, 0};
    float sum = 0;
    for (; run.last < start + count && wide(run.last); ++run.last) {
      sum += width[ring.wrap(run.last)] - 1;
    }
    run.excess = sum / ring.size_px();
    const auto length = static_cast<float>(run.last - run.first);
    i = run.last--;
    const bool fits = length >= kBesideWidths * ring.size_px() && sum / length < kBesideMost - 1;
    if (fits && run.excess > best.excess) std::swap(run, best);
    second = std::max(second, run.excess);
  }
  const bool clear = best.excess > std::max(kBesideExcess, kBesideClear * second);
  return clear ? std::optional(best) : std::nullopt;
}

struct Notch {
  int at = 0;      // the point where it is deepest
  float deep = 0;  // usual widths
};

std::optional<Notch> notch(const Ring& ring) {
  const int count = ring.count();
  const int half = ring.size_px() < 6 ? 1 : static_cast<int>(0.15F * ring.size_px());
  std::vector<float> width;
  for (int i = 0; i < count; ++i) width.push_back(ring.mean_width(i, half));
  const auto least = static_cast<int>(std::min_element(width.begin(), width.end()) - width.begin());
  const float usual = quantile(width, 0.5F);
  const float dip = usual - width[static_cast<std::size_t>(least)];
  const int apart = static_cast<int>(2 * ring.size_px()) + 2;
  float elsewhere = 0;
  for (int i = least + apart; i < least + count - apart; ++i) {
    elsewhere = std::max(elsewhere, usual - width[static_cast<std::size_t>(ring.wrap(i))]);
  }
  if (dip < std::max(kNotchLeast, kNotchClear * elsewhere)) return std::nullopt;
  return Notch{least, dip};
}

// How far to the left the middle steps at point `at`, from the side of `inwards` to the other.
float step_at(const Ring& ring, int at, int inwards, int inside) {
  const auto skip = static_cast<int>(std::ceil(kStepWidths * ring.size_px()));
  const auto most = static_cast<int>(kFitWidths * ring.size_px()) + 4;
  const int most_inside = std::clamp(inside - skip, skip + 3, most);
  Points within;
  Points outside;
  for (int k = skip; k < most_inside; ++k) within.push_back(ring.middle(at + inwards * k));
  for (int k = skip; k < most; ++k) outside.push_back(ring.middle(at - inwards * k));
  return step_aside(outside, within, ring.normal(at)).px;
}

// From the end that the line reaches at `first`, around, to the one it reaches at `last`. The
// strand that arrives at `first` from before goes on to `last`; the other one begins at `first`.
Points passed_twice(const Ring& ring, const Beside& ends) {
  const int inside = ends.last - ends.first + 1;
  const float at_first = step_at(ring, ends.first, 1, inside);
  const float at_last = step_at(ring, ends.last, -1, inside);
  // Where the mask widens to the left, its middle steps to the left: who comes on lies right.
  const float told = at_first - at_last;
  float side = 0;
  if (std::abs(told) > kAsideLeast * ring.size_px()) side = told > 0 ? -1.0F : 1.0F;
  const float off = 0.5F * side;
  Points points;
  const int count = ring.count();
  const int tip = std::min(static_cast<int>(kTipWidths * ring.size_px()), inside / 3);
  for (int i = ends.first + tip; i <= ends.last + count - tip; ++i) {
    const bool leaves = i <= ends.last;
    const bool arrives = i >= ends.first + count;
    const float width = ring.width(i, 1) * ring.usual_px(i);
    const float aside = std::clamp(width - ring.usual_px(i), 0.0F, ring.usual_px(i));
    float move = 0;
    if (arrives) move = off * aside;
    if (leaves) move = -off * aside;
    points.push_back((leaves || arrives ? ring.middle(i) : ring.point(i)) + move * ring.normal(i));
  }
  return points;
}

}  // namespace

void open_rings(Graph& graph, const Region& region) {
  for (Segment& segment : graph.segments) {
    if (!segment.alive || !segment.ring()) continue;
    if (segment.points_px.size() < kLeastPoints) continue;
    const Ring ring(segment.points_px, region.mask, graph.width_px);
    if (const auto ends = ends_beside(ring)) {
      segment.points_px = passed_twice(ring, *ends);
      segment.length_px = length_of(segment.points_px);
      segment.opened = true;
    } else if (const auto touch = notch(ring)) {
      std::rotate(segment.points_px.begin(), segment.points_px.begin() + touch->at,
                  segment.points_px.end());
      segment.opened = touch->deep >= kNotchOfEnds;
    }
  }
}

}  // namespace flowdlo::path
