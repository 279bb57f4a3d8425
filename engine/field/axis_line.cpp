#include "field/axis_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "field/channel.hpp"
#include "field/follower.hpp"
#include "field/region.hpp"
#include "field/surface.hpp"

namespace flowdlo::field {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kClose_px = 0.75F * kRope_px;  // between axes that cross
constexpr int kFar = 24;              // points between stretches of one line that may cross
constexpr int kBrief = 24;            // points next to another line; more lie side by side
constexpr float kChangedOver = 0.2F;  // radians that a line turns by where it may have changed over
constexpr int kTrim = 3;              // points next to a crossing, which bend
constexpr float kTipReach_px = 3;     // around a line's end
constexpr float kCut = 0.7F;          // kTip on a line that two strands make whose ends touch
constexpr float kOpen = 0.3F;         // kTip at which a closed line is opened, or an end is one

float tip_near(const Channels& field, const Vector2f& p) {
  float most = 0;
  const auto reach = static_cast<int>(kTipReach_px);
  for (int dv = -reach; dv <= reach; ++dv) {
    for (int du = -reach; du <= reach; ++du) {
      const int u = pixel_of(p).x + du;
      const int v = pixel_of(p).y + dv;
      if (u < 0 || v < 0 || u >= field.width() || v >= field.height()) continue;
      most = std::max(most, field.at(v, u)[kTip]);
    }
  }
  return most;
}

/// Points of a line where kTip is highest, at least `least`, each a width from the next.
std::vector<std::size_t> peaks(const Points& points, const Surface& surface, float least) {
  const auto apart = static_cast<std::size_t>(kRope_px);
  std::vector<std::size_t> found;
  std::size_t best = 0;
  float most = 0;
  for (std::size_t i = 0; i <= points.size(); ++i) {
    const float tip = i < points.size() ? surface.at(points[i], kTip) : 0;
    if (tip >= least && tip > most) {
      most = tip;
      best = i;
    }
    if (most > 0 && (i == points.size() || i - best >= apart)) {
      found.push_back(best);
      most = 0;
    }
  }
  return found;
}

/// A closed line from where it looks most like its ends, and opened if they show there.
void begin_at_tip(AxisLine& line, const Surface& surface) {
  std::vector<float> tips;
  for (const Vector2f& p : line.points_px) tips.push_back(surface.at(p, kTip));
  const auto highest = std::max_element(tips.begin(), tips.end());
  if (highest == tips.end()) return;
  line.closed = *highest < kOpen;
  std::rotate(line.points_px.begin(), line.points_px.begin() + (highest - tips.begin()),
              line.points_px.end());
}

/// A line cut where two ends touch.
std::vector<AxisLine> parted(AxisLine line, const Surface& surface) {
  if (line.closed) begin_at_tip(line, surface);
  if (line.closed) return {std::move(line)};
  std::vector<AxisLine> parts;
  std::size_t first = 0;
  const auto apart = static_cast<std::size_t>(kRope_px);
  for (const std::size_t cut : peaks(line.points_px, surface, kCut)) {
    if (cut < first + apart || cut + apart > line.points_px.size()) continue;
    parts.emplace_back().points_px.assign(
        line.points_px.begin() + static_cast<std::ptrdiff_t>(first),
        line.points_px.begin() + static_cast<std::ptrdiff_t>(cut));
    first = cut + 1;
  }
  line.points_px.erase(line.points_px.begin(),
                       line.points_px.begin() + static_cast<std::ptrdiff_t>(first));
  parts.push_back(std::move(line));
  return parts;
}

/// All lines' points by the cell of a grid that they lie in, to find what else runs near a place.
/// Of those within one pixel the last one counts alone.
class Neighbours {
 public:
  Neighbours(const std::vector<AxisLine>& lines, const Channels& field)
      : columns_(field.width() / kCell_px + 1),
        rows_(field.height() / kCell_px + 1),
        head_(static_cast<std::size_t>(columns_ * rows_), -1) {
    using Name = std::array<int, 2>;
    BlockImage<Name> last(field.size(), field.map(), Name{-1, 0});
    for_points(lines, [&](const image::Point& pixel, const Entry& entry) {
      if (Name* const at = last.find(pixel.y, pixel.x); at != nullptr) {
        *at = {entry.line, entry.index};
      }
    });
    for_points(lines, [&](const image::Point& pixel, const Entry& entry) {
      const Name* const at = last.find(pixel.y, pixel.x);
      if (at == nullptr || *at != Name{entry.line, entry.index}) return;
      int& head = head_[cell(pixel.x / kCell_px, pixel.y / kCell_px)];
      entries_.push_back(entry);
      entries_.back().next = head;
      head = static_cast<int>(entries_.size()) - 1;
    });
  }

  /// Whether another line, or a far stretch of the same one, runs within kClose_px of a point.
  [[nodiscard]] bool close(const std::vector<AxisLine>& lines, int line, int index) const {
    const AxisLine& own = lines[static_cast<std::size_t>(line)];
    const Vector2f& p = own.points_px[static_cast<std::size_t>(index)];
    const auto count = static_cast<int>(own.points_px.size());
    const auto is_close = [&](const Entry& there) {
      int apart = std::abs(there.index - index);
      if (own.closed) apart = std::min(apart, count - apart);
      if (there.line == line && apart <= kFar) return false;
      return (there.px - p).norm() <= kClose_px;
    };
    const auto reach = static_cast<int>(kClose_px) + 1;
    const image::Point middle = pixel_of(p);
    const auto within = [](int px, int cells) { return std::clamp(px / kCell_px, 0, cells - 1); };
    for (int y = within(middle.y - reach, rows_); y <= within(middle.y + reach, rows_); ++y) {
      for (int x = within(middle.x - reach, columns_); x <= within(middle.x + reach, columns_);
           ++x) {
        for (int i = head_[cell(x, y)]; i >= 0; i = entries_[static_cast<std::size_t>(i)].next) {
          if (is_close(entries_[static_cast<std::size_t>(i)])) return true;
        }
      }
    }
    return false;
  }

 private:
  static constexpr int kCell_px = 16;

  struct Entry {
    int line = 0;
    int index = 0;  // of its point
    Vector2f px{0, 0};
    int next = -1;  // in the same cell; -1: none
  };

  template <class Visit>
  static void for_points(const std::vector<AxisLine>& lines, const Visit& visit) {
    for (std::size_t l = 0; l < lines.size(); ++l) {
      for (std::size_t i = 0; i < lines[l].points_px.size(); ++i) {
        const Vector2f& p = lines[l].points_px[i];
        visit(pixel_of(p), Entry{static_cast<int>(l), static_cast<int>(i), p});
      }
    }
  }
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  int columns_;
  int rows_;
  std::vector<int> head_;  // [rows, columns] into `entries_`, -1: none
  std::vector<Entry> entries_;
};

/// By how much a line turns from before point `first` to behind point `last`, radians; 0 where it
/// ends there.
float turn_across(const Points& points, int first, int last) {
  constexpr int kArm = static_cast<int>(0.75F * kRope_px);
  if (first < kArm || last + kArm >= static_cast<int>(points.size())) return 0;
  const auto point = [&](int i) { return points[static_cast<std::size_t>(i)]; };
  const Vector2f in = point(first) - point(first - kArm);
  const Vector2f out = point(last + kArm) - point(last);
  return std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out)));
}

using Stretch = std::pair<int, int>;  // first and last point

/// The short stretches of a line where another one comes close and this one turns; `close`
/// [points].
std::vector<Stretch> doubtful(const AxisLine& line, const std::vector<char>& close) {
  const auto count = static_cast<int>(line.points_px.size());
  std::vector<Stretch> found;
  for (int i = 0; i < count; ++i) {
    if (close[static_cast<std::size_t>(i)] == 0) continue;
    int last = i;
    while (last + 1 < count && close[static_cast<std::size_t>(last + 1)] != 0) ++last;
    if (last - i < kBrief && turn_across(line.points_px, i, last) > kChangedOver) {
      const int free = found.empty() ? 0 : found.back().second + 1;
      found.emplace_back(std::max(i - kTrim, free), std::min(last + kTrim, count - 1));
    }
    i = last;
  }
  return found;
}

/// What is left of a line without `stretches`, which come in order; a closed one is opened.
std::vector<AxisLine> without(AxisLine line, std::vector<Stretch> stretches) {
  if (stretches.empty()) return {std::move(line)};
  auto& points = line.points_px;
  if (line.closed) {
    const auto [first, last] = stretches.front();
    std::rotate(points.begin(), points.begin() + last + 1, points.end());
    points.resize(points.size() - static_cast<std::size_t>(last - first + 1));
    for (auto& [from, to] : stretches) {
      from -= last + 1;
      to -= last + 1;
    }
    stretches.erase(stretches.begin());
  }
  std::vector<AxisLine> pieces;
  int from = 0;
  stretches.emplace_back(static_cast<int>(points.size()), 0);
  for (const auto& [first, last] : stretches) {
    if (first - from >= 2) {
      pieces.emplace_back().points_px.assign(points.begin() + from, points.begin() + first);
    }
    from = last + 1;
  }
  return pieces;
}

/// The lines without the short stretches where one comes close to another and turns: there it may
/// have changed over to the other, for directions mix at a crossing.
std::vector<AxisLine> untangled(const std::vector<AxisLine>& lines, const Channels& field) {
  const Neighbours neighbours(lines, field);
  std::vector<AxisLine> result;
  for (int l = 0; l < static_cast<int>(lines.size()); ++l) {
    AxisLine line = lines[static_cast<std::size_t>(l)];
    const auto count = static_cast<int>(line.points_px.size());
    std::vector<char> close;
    for (int i = 0; i < count; ++i) close.push_back(neighbours.close(lines, l, i) ? 1 : 0);
    if (line.closed) {  // begun where nothing is near, so that no stretch goes over the end
      const auto clear = (std::find(close.begin(), close.end(), 0) - close.begin()) % count;
      std::rotate(line.points_px.begin(), line.points_px.begin() + clear, line.points_px.end());
      std::rotate(close.begin(), close.begin() + clear, close.end());
    }
    const auto stretches = doubtful(line, close);
    for (AxisLine& piece : without(std::move(line), stretches)) result.push_back(std::move(piece));
  }
  return result;
}

/// Off an end that is no tip: what bends there towards the strand that it meets.
void trim(AxisLine& line) {
  auto& points = line.points_px;
  if (static_cast<int>(points.size()) < 6 * kTrim + 2) return;
  if (line.tips[1] < kOpen) points.erase(points.end() - kTrim, points.end());
  if (line.tips[0] < kOpen) points.erase(points.begin(), points.begin() + kTrim);
}

}  // namespace

std::vector<AxisLine> axis_lines(const Channels& field) {
  const Surface surface(field);
  std::vector<AxisLine> lines;
  for (AxisLine& whole : untangled(follow_ridges(field), field)) {
    for (AxisLine& line : parted(std::move(whole), surface)) {
      if (line.points_px.size() < 2) continue;
      if (!line.closed) {
        line.tips = {tip_near(field, line.points_px.front()),
                     tip_near(field, line.points_px.back())};
        trim(line);
      }
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace flowdlo::field
