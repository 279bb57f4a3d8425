#include "strand/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <unordered_map>

#include "field/channel.hpp"
#include "geometry/quantile.hpp"
#include "mat/mat_image.hpp"
#include "path/thinning.hpp"
#include "strand/targets.hpp"

namespace flowdlo::strand {
namespace {

constexpr float kNearWidths = 0.25F;
constexpr float kNear_px = 1;
constexpr float kDegrees = 20;
constexpr float kMergedWidths = 1.5F;
constexpr float kApartWidths = 4;  // of arclength between two strands
constexpr float kStep_px = 0.7F;   // between places
constexpr float kPi = 3.14159265F;

/// A place of a strand, thinned out so that every strand counts by its length.
struct Place {
  float u = 0;
  float v = 0;
  float width = 0;
  float angle = 0;
  float along = 0;
  int rope = 0;
  bool merged = false;
};

std::vector<Place> places_of(const std::vector<Strand>& strands) {
  std::vector<Place> places;
  for (const Strand& strand : strands) {
    const auto& points = strand.points;
    float since = kStep_px;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i > 0) since += std::hypot(points[i].u - points[i - 1].u, points[i].v - points[i - 1].v);
      if (points[i].seen != Seen::kYes || since < kStep_px) continue;
      since = 0;
      const AxisPoint& a = points[i > 2 ? i - 2 : 0];
      const AxisPoint& b = points[std::min(points.size() - 1, i + 2)];
      places.push_back({points[i].u, points[i].v, 2 * points[i].radius_px,
                        std::atan2(b.v - a.v, b.u - a.u), points[i].along_widths, strand.rope,
                        false});
    }
  }
  return places;
}

/// Points by cells, to find those near a place.
template <class Point>
class Grid {
 public:
  Grid(const std::vector<Point>& points, float cell) : points_(points), cell_(cell) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      cells_[key(cell_of(x(points[i])), cell_of(y(points[i])))].push_back(i);
    }
  }

  /// visit(index, distance) for all within `reach`.
  template <class Visit>
  void near(float u, float v, float reach, const Visit& visit) const {
    for (int row = cell_of(v - reach); row <= cell_of(v + reach); ++row) {
      for (int column = cell_of(u - reach); column <= cell_of(u + reach); ++column) {
        const auto found = cells_.find(key(column, row));
        if (found == cells_.end()) continue;
        for (const std::size_t i : found->second) {
          const float distance = std::hypot(x(points_[i]) - u, y(points_[i]) - v);
          if (distance <= reach) visit(i, distance);
        }
      }
    }
  }

 private:
  static float x(const Place& place) { return place.u; }
  static float y(const Place& place) { return place.v; }
  static float x(const field::RidgePoint& point) { return point.px.x(); }
  static float y(const field::RidgePoint& point) { return point.px.y(); }
  static std::int64_t key(int column, int row) {
    return (static_cast<std::int64_t>(row) << 32) + column;
  }
  [[nodiscard]] int cell_of(float at) const { return static_cast<int>(std::floor(at / cell_)); }

  const std::vector<Point>& points_;
  float cell_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

void mark_merged(std::vector<Place>& places) {
  const Grid<Place> grid(places, 8);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    bool merged = false;
    grid.near(place.u, place.v, kMergedWidths * place.width, [&](std::size_t k, float) {
      const Place& other = places[k];
      merged =
          merged || other.rope != place.rope || std::abs(other.along - place.along) > kApartWidths;
    });
    places[i].merged = merged;
  }
}

bool same_direction(float a, float b) {
  return std::abs(std::sin(a - b)) < std::sin(kDegrees * kPi / 180);
}

float middle_width(const std::vector<Place>& places) {
  std::vector<float> widths;
  for (const Place& place : places) widths.push_back(place.width);
  return geometry::median_of(widths);
}

void measure_tips(const std::vector<Strand>& strands, const std::vector<Eigen::Vector2f>& tips,
                  float width, Counts& counts) {
  const auto ends = visible_tips(strands);
  const auto near = [&](const cv::Point2f& end, const Eigen::Vector2f& tip) {
    return std::hypot(end.x - tip.x(), end.y - tip.y()) < width;
  };
  for (const auto& end : ends) {
    ++counts.ends;
    counts.ends_found +=
        std::any_of(tips.begin(), tips.end(), [&](const auto& tip) { return near(end, tip); });
  }
  for (const auto& tip : tips) {
    ++counts.tips;
    counts.tips_right +=
        std::any_of(ends.begin(), ends.end(), [&](const auto& end) { return near(end, tip); });
  }
}

}  // namespace

Counts& Counts::operator+=(const Counts& other) {
  places += other.places;
  found += other.found;
  merged_places += other.merged_places;
  merged_found += other.merged_found;
  shown += other.shown;
  right += other.right;
  merged_shown += other.merged_shown;
  merged_right += other.merged_right;
  ends += other.ends;
  ends_found += other.ends_found;
  tips += other.tips;
  tips_right += other.tips_right;
  crossings += other.crossings;
  crossings_right += other.crossings_right;
  return *this;
}

std::vector<Strand> in_region(const std::vector<Strand>& strands, const field::Region& region) {
  std::vector<Strand> result = strands;
  for (Strand& strand : result) {
    for (AxisPoint& point : strand.points) {
      const Eigen::Vector2f at = region.to_region({point.u, point.v});
      point.u = at.x();
      point.v = at.y();
      point.radius_px *= region.scale.x();
    }
  }
  return result;
}

Counts measure(const std::vector<Strand>& strands, const cv::Mat& mask,
               const std::vector<field::RidgePoint>& ridge,
               const std::vector<Eigen::Vector2f>& tips) {
  Counts counts;
  auto places = places_of(strands);
  if (places.empty()) return counts;
  mark_merged(places);
  cv::Mat around;
  cv::dilate(mask, around, cv::Mat::ones(5, 5, CV_8U));
  const Grid<field::RidgePoint> shown(ridge, 8);
  for (const Place& place : places) {
    const int u = static_cast<int>(std::lround(place.u));
    const int v = static_cast<int>(std::lround(place.v));
    if (u < 0 || v < 0 || u >= mask.cols || v >= mask.rows) continue;
    if (around.at<float>(v, u) < 0.5F) continue;
    bool found = false;
    shown.near(place.u, place.v, kNearWidths * place.width, [&](std::size_t i, float) {
      found = found || same_direction(ridge[i].angle, place.angle);
    });
    ++counts.places;
    counts.found += found;
    counts.merged_places += place.merged;
    counts.merged_found += place.merged && found;
  }
  const Grid<Place> there(places, 8);
  for (const field::RidgePoint& point : ridge) {
    float nearest = std::numeric_limits<float>::max();
    const Place* of = nullptr;
    there.near(point.px.x(), point.px.y(), 24, [&](std::size_t i, float distance) {
      if (distance >= nearest) return;
      nearest = distance;
      of = &places[i];
    });
    const bool right = of != nullptr && nearest <= std::max(kNearWidths * of->width, kNear_px);
    ++counts.shown;
    counts.right += right;
    if (of == nullptr || !of->merged) continue;
    ++counts.merged_shown;
    counts.merged_right += right;
  }
  measure_tips(strands, tips, middle_width(places), counts);
  return counts;
}

TipLevels& TipLevels::operator+=(const TipLevels& other) {
  tips.insert(tips.end(), other.tips.begin(), other.tips.end());
  ends.insert(ends.end(), other.ends.begin(), other.ends.end());
  return *this;
}

TipLevels tip_levels(const std::vector<Strand>& strands, const field::Channels& field,
                     float least) {
  TipLevels levels;
  const auto places = places_of(strands);
  if (places.empty()) return levels;
  const float width = middle_width(places);
  const auto ends = visible_tips(strands);
  levels.ends.assign(ends.size(), 0);
  for (const Eigen::Vector2f& tip : field::tips(field, least)) {
    const auto level = field.at(static_cast<int>(tip.y()), static_cast<int>(tip.x()))[field::kTip];
    levels.tips.push_back({tip, level, false});
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (std::hypot(ends[i].x - tip.x(), ends[i].y - tip.y()) >= width) continue;
      levels.tips.back().right = true;
      levels.ends[i] = std::max(levels.ends[i], level);
    }
  }
  return levels;
}

void measure_crossings(const std::vector<Strand>& strands, const cv::Mat& field, Counts& counts) {
  // The middle of each stretch that runs below a strand; long ones lie along it, not across.
  constexpr float kMostWidths = 4;
  constexpr float kLeastSine = 0.5F;
  const auto places = places_of(strands);
  const Grid<Place> there(places, 8);
  for (const Strand& strand : strands) {
    const auto& points = strand.points;
    for (std::size_t i = 0; i < points.size();) {
      std::size_t last = i;
      while (last < points.size() && points[last].seen == Seen::kUnder) ++last;
      if (last == i) {
        ++i;
        continue;
      }
      const AxisPoint& middle = points[(i + last) / 2];
      const bool whole = i > 2 && last + 3 < points.size();
      const float widths = std::abs(points[last - 1].along_widths - points[i].along_widths);
      const std::size_t before = i;
      i = last;
      if (!whole || widths > kMostWidths) continue;
      const float below =
          std::atan2(points[last].v - points[before].v, points[last].u - points[before].u);
      const Place* upper = nullptr;
      float nearest = middle.radius_px;
      there.near(middle.u, middle.v, nearest, [&](std::size_t k, float distance) {
        if (distance > nearest) return;
        nearest = distance;
        upper = &places[k];
      });
      if (upper == nullptr || std::abs(std::sin(upper->angle - below)) < kLeastSine) continue;
      const int u = static_cast<int>(std::lround(middle.u));
      const int v = static_cast<int>(std::lround(middle.v));
      if (u < 0 || v < 0 || u >= field.cols || v >= field.rows) continue;
      const float* const at = field.ptr<float>(v) + u * field::kChannels;
      const float seen = 0.5F * std::atan2(at[field::kSin], at[field::kCos]);
      ++counts.crossings;
      counts.crossings_right +=
          std::abs(std::sin(seen - upper->angle)) < std::abs(std::sin(seen - below));
    }
  }
}

std::vector<field::RidgePoint> thinned(const cv::Mat& mask) {
  cv::Mat binary;
  cv::threshold(mask, binary, 0.5, 1, cv::THRESH_BINARY);
  binary.convertTo(binary, CV_8U);
  cv::copyMakeBorder(binary, binary, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  const cv::Mat skeleton = mat::mat_of(path::thin(mat::image_of<std::uint8_t>(binary)));
  std::vector<field::RidgePoint> points;
  for (int v = 0; v < skeleton.rows; ++v) {
    for (int u = 0; u < skeleton.cols; ++u) {
      if (skeleton.at<std::uint8_t>(v, u) == 0) continue;
      points.push_back({{static_cast<float>(u - 1), static_cast<float>(v - 1)}, 0, 1});
    }
  }
  // Each point's direction is that of the skeleton around it.
  constexpr float kAround_px = 6;
  const Grid<field::RidgePoint> grid(points, 8);
  std::vector<field::RidgePoint> result = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Matrix2f spread = Eigen::Matrix2f::Zero();
    Eigen::Vector2f mean = Eigen::Vector2f::Zero();
    int count = 0;
    grid.near(points[i].px.x(), points[i].px.y(), kAround_px, [&](std::size_t k, float) {
      mean += points[k].px;
      ++count;
    });
    mean /= static_cast<float>(count);
    grid.near(points[i].px.x(), points[i].px.y(), kAround_px, [&](std::size_t k, float) {
      const Eigen::Vector2f off = points[k].px - mean;
      spread += off * off.transpose();
    });
    result[i].angle = 0.5F * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  }
  return result;
}

}  // namespace flowdlo::strand
