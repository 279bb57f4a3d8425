#include "gate/axes_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;

constexpr float kBeside = 0.5F;       // widths between a curve and the axis that it runs along
constexpr float kSameWay = 0.866F;    // cosine of the angle between both
constexpr float kAnotherTime = 2.0F;  // widths of curve after which it runs along an axis once more
constexpr float kTipReach = 1.5F;     // widths between an end and the tip that it meets

/// A place on an axis.
struct Station {
  Vector2f px{0, 0};
  Vector2f along{1, 0};
  float length_px = 0;  // of the axis that it stands for
};

/// Points of the line about a quarter of a width apart.
std::vector<Station> stations_of(const field::AxisLine& line, float width_px) {
  std::vector<Station> stations;
  const auto& points = line.points_px;
  const float spacing_px = std::max(1.0F, 0.25F * width_px);
  Vector2f from = points.front();
  float walked_px = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    walked_px += (points[i] - points[i - 1]).norm();
    if (walked_px < spacing_px && i + 1 < points.size()) continue;
    const Vector2f chord = points[i] - from;
    if (chord.norm() > 0) {
      stations.push_back({0.5F * (points[i] + from), chord.normalized(), walked_px});
    }
    from = points[i];
    walked_px = 0;
  }
  return stations;
}

bool runs_along(const Station& station, const CurvePoint& point, float width_px) {
  return (station.px - point.px).squaredNorm() <= kBeside * kBeside * width_px * width_px &&
         std::abs(station.along.dot(point.along)) >= kSameWay;
}

/// The points of a curve by where they lie.
class Grid {
 public:
  Grid(const ImageCurve& curve, float cell_px) : cell_px_(cell_px) {
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const auto [column, row] = cell_of(curve.points[i].px);
      cells_[key(column, row)].push_back(i);
    }
  }

  /// Those up to a cell away and some more, in the curve's order.
  [[nodiscard]] std::vector<std::size_t> near(const Vector2f& px) const {
    std::vector<std::size_t> points;
    const auto [column, row] = cell_of(px);
    for (int c = column - 1; c <= column + 1; ++c) {
      for (int r = row - 1; r <= row + 1; ++r) {
        const auto cell = cells_.find(key(c, r));
        if (cell == cells_.end()) continue;
        points.insert(points.end(), cell->second.begin(), cell->second.end());
      }
    }
    std::sort(points.begin(), points.end());
    return points;
  }

 private:
  [[nodiscard]] std::array<int, 2> cell_of(const Vector2f& px) const {
    return {static_cast<int>(std::floor(px.x() / cell_px_)),
            static_cast<int>(std::floor(px.y() / cell_px_))};
  }
  [[nodiscard]] static std::int64_t key(int column, int row) {
    return static_cast<std::int64_t>(column) * (std::int64_t{1} << 32) + row;
  }

  float cell_px_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

/// How often the curve runs along there; `backed` is marked for the points that do.
int times_along(const Station& station, const ImageCurve& curve, const Grid& grid, float width_px,
                std::vector<bool>& backed) {
  int times = 0;
  float last_px = 0;
  for (const std::size_t i : grid.near(station.px)) {
    const CurvePoint& point = curve.points[i];
    if (!runs_along(station, point, width_px)) continue;
    backed[i] = true;
    if (times == 0 || point.length_px - last_px > kAnotherTime * width_px) ++times;
    last_px = point.length_px;
  }
  return times;
}

/// Of the tips, how much the curve's ends meet and leave.
void score_tips(const field::Axes& axes, const ImageCurve& curve, float width_px,
                AxesScore& score) {
  const float reach_px = kTipReach * width_px;
  std::array<float, 2> met{0, 0};
  const std::array<Vector2f, 2> ends{curve.points.front().px, curve.points.back().px};
  for (const field::AxisLine& line : axes.lines) {
    if (line.closed) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vector2f& tip = side == 0 ? line.points_px.front() : line.points_px.back();
      const std::size_t nearer = (tip - ends[0]).norm() <= (tip - ends[1]).norm() ? 0 : 1;
      if ((tip - ends[nearer]).norm() <= reach_px) {
        met[nearer] = std::max(met[nearer], line.tips[side]);
      } else {
        score.tips_left += 0.5F * line.tips[side];
      }
    }
  }
  score.tips_met = 0.5F * (met[0] + met[1]);
}

}  // namespace

AxesScore score_axes(const field::Axes& axes, const ImageCurve& curve) {
  AxesScore score;
  score.known = true;
  if (curve.points.empty()) return score;
  const float width_px = std::max(1.0F, axes.width_px);
  const Grid grid(curve, kBeside * width_px);
  std::vector<bool> backed(curve.points.size(), false);
  float length_px = 0;
  for (const field::AxisLine& line : axes.lines) {
    for (const Station& station : stations_of(line, width_px)) {
      const int times = times_along(station, curve, grid, width_px, backed);
      length_px += station.length_px;
      score.followed += times > 0 ? station.length_px : 0;
      score.twice += times > 1 ? station.length_px : 0;
    }
  }
  if (length_px > 0) {
    score.followed /= length_px;
    score.twice /= length_px;
  }
  score.backed = static_cast<float>(std::count(backed.begin(), backed.end(), true)) /
                 static_cast<float>(backed.size());
  score_tips(axes, curve, width_px, score);
  return score;
}

}  // namespace flowdlo::gate
