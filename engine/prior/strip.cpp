#include "prior/strip.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "evidence/beside_rope.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

using Eigen::Vector2f;

constexpr float kStationsPerWidth = 8;
constexpr float kReadingsPerWidth = 10;
constexpr int kMostStations = 8192;
constexpr float kTangentWidths = 0.35F;  // to both sides
constexpr float kEdgeWidths = 1.8F;      // how far the mask's edge is looked for
constexpr float kOffAxisWidths = 0.3F;   // how far the path may leave the mask and still be on it
constexpr float kBesidePx = 2.5F;        // beyond the mask's edge: clear of mixed pixels
constexpr float kSteepestGround = 2.7F;  // metres of depth a metre aside
constexpr float kStrandWidths = 3.0F;    // stations farther apart along the path: other strands
constexpr float kStrandPx = 4.0F;
constexpr float kMostCells = 512;        // of the grid, to a side
constexpr float kSameWay = 0.5F;         // cosine between both ends of a ring
constexpr float kNearWidths = 1.15F;     // strands nearer than this share pixels
constexpr std::size_t kScattered = 800;  // pixels with a depth; fewer than that all count
constexpr float kCoverWidths = 0.5F;     // a strand covers what is this near to its axis

class Image {
 public:
  explicit Image(const Frame& frame) : frame_(frame) {}

  /// Index of the pixel at `p`, -1 outside of the image.
  [[nodiscard]] std::ptrdiff_t pixel(const Vector2f& p) const {
    const auto u = static_cast<int>(std::floor(p.x() + 0.5F));
    const auto v = static_cast<int>(std::floor(p.y() + 0.5F));
    if (u < 0 || v < 0 || u >= frame_.width || v >= frame_.height) return -1;
    return static_cast<std::ptrdiff_t>(v) * frame_.width + u;
  }
  [[nodiscard]] bool masked(const Vector2f& p) const {
    const std::ptrdiff_t at = pixel(p);
    return at >= 0 && frame_.mask[static_cast<std::size_t>(at)] > 127;
  }
  [[nodiscard]] float depth_m(std::ptrdiff_t pixel) const {
    const float depth = frame_.depth_m[static_cast<std::size_t>(pixel)];
    return geometry::measured(depth) ? depth : 0;
  }
  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] Eigen::Vector3f point(const Vector2f& p, float depth_m) const {
    return geometry::to_eigen(geometry::unproject(frame_.intrinsics, p.x(), p.y(), depth_m));
  }
  [[nodiscard]] Vector2f centre(std::ptrdiff_t pixel) const {
    return {static_cast<float>(pixel % frame_.width), static_cast<float>(pixel / frame_.width)};
  }

 private:
  const Frame& frame_;
};

std::vector<Station> place_stations(std::span<const Vector2f> path_px, float width_px,
                                    const Intrinsics& camera) {
  const float length = geometry::cumulative_length(path_px).back();
  const float wanted = std::max(1.0F, width_px / kStationsPerWidth);
  const int count =
      std::clamp(static_cast<int>(std::lround(length / wanted)) + 1, 2, kMostStations);
  const float step = length / static_cast<float>(count - 1);
  const std::vector<Vector2f> points = geometry::resample(path_px, count);
  const int reach =
      std::max(1, static_cast<int>(std::lround(kTangentWidths * width_px / std::max(step, 1e-3F))));
  std::vector<Station> stations(points.size());
  for (int i = 0; i < count; ++i) {
    Station& station = stations[static_cast<std::size_t>(i)];
    station.point_px = points[static_cast<std::size_t>(i)];
    station.arclength_px = static_cast<float>(i) * step;
    const Vector2f along = points[static_cast<std::size_t>(std::min(i + reach, count - 1))] -
                           points[static_cast<std::size_t>(std::max(i - reach, 0))];
    const Vector2f tangent = along.norm() > 0 ? Vector2f(along.normalized()) : Vector2f(1, 0);
    station.normal = {-tangent.y(), tangent.x()};
    station.ray = {(station.point_px.x() - camera.cx) / camera.fx,
                   (station.point_px.y() - camera.cy) / camera.fy, 1};
    const Eigen::Vector3f along_m{tangent.x() / camera.fx, tangent.y() / camera.fy, 0};
    const Eigen::Vector3f across_m{station.normal.x() / camera.fx, station.normal.y() / camera.fy,
                                   0};
    station.aside = std::abs(station.ray.cross(along_m).normalized().dot(across_m));
  }
  return stations;
}

/// Mean depth at `p` and a little farther out, where there is no mask; 0 without any.
float beyond_m(const Vector2f& p, const Vector2f& outward, const Image& image) {
  float sum = 0;
  int count = 0;
  for (const float step : {0.0F, 1.5F, 3.0F}) {
    const std::ptrdiff_t pixel = image.pixel(p + step * outward);
    if (pixel < 0 || image.masked(p + step * outward)) continue;
    const float depth_m = image.depth_m(pixel);
    if (depth_m <= 0) continue;
    sum += depth_m;
    ++count;
  }
  return count > 0 ? sum / static_cast<float>(count) : 0;
}

/// What lies beside the rope, on one side.
struct Side {
  float offset_px = 0;  ///< from the axis
  float depth_m = 0;    ///< 0: unknown
};

Side ground_beside(const Station& station, float direction, float edge_px, const Image& image) {
  const evidence::BesideRope at = evidence::BesideRope::of_width(image.frame().width);
  const Vector2f outward = direction * station.normal;
  return {edge_px + 0.5F * static_cast<float>(at.from_px + at.to_px),
          evidence::depth_beside(station.point_px + edge_px * outward, outward, at, image.frame())};
}

/// A line through what lies on both sides.
void find_ground(const Image& image, Station& station) {
  if (!station.bounded) return;
  const Side left = ground_beside(station, -1, station.left_px, image);
  const Side right = ground_beside(station, 1, station.right_px, image);
  if (left.depth_m <= 0 || right.depth_m <= 0) return;
  const float span_px = left.offset_px + right.offset_px;
  const float rise_m = right.depth_m - left.depth_m;
  const float middle_m = left.depth_m + rise_m * left.offset_px / span_px;
  if (std::abs(rise_m) > kSteepestGround * span_px * station.aside * middle_m) return;
  station.ground_m = middle_m;
  station.ground_across =
      image.point(station.point_px + right.offset_px * station.normal, right.depth_m) -
      image.point(station.point_px - left.offset_px * station.normal, left.depth_m);
}

/// Walks from the axis to the mask's edges and keeps what lies within half a width.
void read_across(int index, float width_px, const Image& image, Strip& strip) {
  Station& station = strip.stations[static_cast<std::size_t>(index)];
  const float step = std::max(1.0F, width_px / kReadingsPerWidth);
  const auto at = [&](float offset) {
    return Vector2f(station.point_px + offset * station.normal);
  };
  float start = 0;
  station.masked = image.masked(at(0));
  for (float off = 1; !station.masked && off <= kOffAxisWidths * width_px; ++off) {
    for (const float offset : {off, -off}) {
      if (station.masked || !image.masked(at(offset))) continue;
      station.masked = true;
      start = offset;
    }
  }
  if (!station.masked) return;
  const float most = kEdgeWidths * width_px + 1;
  const auto edge = [&](float direction) {
    float reach = 0;
    while (reach < most && image.masked(at(start + direction * (reach + step)))) reach += step;
    for (float part = 0.5F * step; part > 0.2F; part *= 0.5F) {  // to a quarter of a pixel
      if (image.masked(at(start + direction * (reach + part)))) reach += part;
    }
    return reach;
  };
  const float left = edge(-1);
  const float right = edge(1);
  station.left_px = left - start;
  station.right_px = right + start;
  station.bounded = left < most && right < most;
  const Vector2f& across = station.normal;
  find_ground(image, station);
  station.beside_m = std::max(beyond_m(at(-station.left_px) - kBesidePx * across, -across, image),
                              beyond_m(at(station.right_px) + kBesidePx * across, across, image));
  const float half = 0.5F * width_px;
  const auto first = static_cast<int>(std::ceil(std::max(-half, -station.left_px) / step));
  const auto last = static_cast<int>(std::floor(std::min(half, station.right_px) / step));
  for (int k = first; k <= last; ++k) {
    const std::ptrdiff_t pixel = image.pixel(at(static_cast<float>(k) * step));
    if (pixel < 0) continue;
    const float depth_m = image.depth_m(pixel);
    if (depth_m <= 0) continue;
    const float offset = (image.centre(pixel) - station.point_px).dot(station.normal);
    strip.readings.push_back({index, offset, depth_m, -1, 0});
  }
}

/// Which strands come near which: a grid over the stations.
class Neighbours {
 public:
  Neighbours(const Strip& strip, float reach_px)
      : strip_(strip), reach_px_(reach_px), closed_(closed(strip)) {
    Vector2f low = strip.stations.front().point_px;
    Vector2f high = low;
    for (const Station& station : strip.stations) {
      low = low.cwiseMin(station.point_px);
      high = high.cwiseMax(station.point_px);
    }
    low_ = low;
    cell_px_ = std::max(reach_px, (high - low).maxCoeff() / kMostCells);
    columns_ = static_cast<int>((high.x() - low.x()) / cell_px_) + 1;
    rows_ = static_cast<int>((high.y() - low.y()) / cell_px_) + 1;
    first_.assign(static_cast<std::size_t>(columns_) * rows_, -1);
    next_.assign(strip.stations.size(), -1);
    for (int i = static_cast<int>(strip.stations.size()) - 1; i >= 0; --i) {
      int& head = first_[static_cast<std::size_t>(cell(i))];
      next_[static_cast<std::size_t>(i)] = head;
      head = i;
    }
  }

  /// Nearest station within reach that lies on another strand; -1 when there is none.
  [[nodiscard]] int nearest(int index, float apart_px) const {
    const Station& from = strip_.stations[static_cast<std::size_t>(index)];
    float least = reach_px_ * reach_px_;
    int best = -1;
    const int column = cell(index) % columns_;
    const int row = cell(index) / columns_;
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
        int i = first_[static_cast<std::size_t>(r) * columns_ + c];
        for (; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
          const Station& to = strip_.stations[static_cast<std::size_t>(i)];
          if (along(from, to) < apart_px) continue;
          const float squared = (to.point_px - from.point_px).squaredNorm();
          if (squared >= least) continue;
          least = squared;
          best = i;
        }
      }
    }
    return best;
  }

  /// From one station to the other along the path, round a ring the shorter way.
  [[nodiscard]] float along(const Station& from, const Station& to) const {
    const float way = std::abs(to.arclength_px - from.arclength_px);
    return closed_ ? std::min(way, strip_.stations.back().arclength_px - way) : way;
  }

 private:
  /// Whether the path ends where it began.
  static bool closed(const Strip& strip) {
    const Station& first = strip.stations.front();
    const Station& last = strip.stations.back();
    return (first.point_px - last.point_px).norm() < strip.width_px &&
           first.normal.dot(last.normal) > kSameWay &&
           last.arclength_px > 2 * kStrandWidths * strip.width_px;
  }
  [[nodiscard]] int cell(int index) const {
    const Vector2f p = strip_.stations[static_cast<std::size_t>(index)].point_px - low_;
    return static_cast<int>(p.y() / cell_px_) * columns_ + static_cast<int>(p.x() / cell_px_);
  }

  const Strip& strip_;
  float reach_px_;
  float cell_px_ = 1;
  bool closed_;
  Vector2f low_{0, 0};
  int columns_ = 1;
  int rows_ = 1;
  std::vector<int> first_;  // station at the head of each cell's list
  std::vector<int> next_;
};

/// From station `at` downhill to the one nearest to `p`.
int descend(const std::vector<Station>& stations, int at, const Vector2f& p) {
  const auto distance = [&](int i) {
    return (stations[static_cast<std::size_t>(i)].point_px - p).squaredNorm();
  };
  const int last = static_cast<int>(stations.size()) - 1;
  for (const int direction : {1, -1}) {
    int next = at + direction;
    while (next >= 0 && next <= last && distance(next) < distance(at)) {
      at = next;
      next += direction;
    }
  }
  return at;
}

float apart_px(const Strip& strip) { return kStrandWidths * strip.width_px + kStrandPx; }

void find_neighbours(const Neighbours& neighbours, Strip& strip) {
  strip.neighbour.resize(strip.stations.size());
  for (int i = 0; i < static_cast<int>(strip.stations.size()); ++i) {
    strip.neighbour[static_cast<std::size_t>(i)] = neighbours.nearest(i, apart_px(strip));
  }
}

void find_rival(const Neighbours& neighbours, const Strip& strip, Reading& reading) {
  const int neighbour = strip.neighbour[static_cast<std::size_t>(reading.station)];
  if (neighbour < 0) return;
  const Station& own = strip.stations[static_cast<std::size_t>(reading.station)];
  const Vector2f p = own.point_px + reading.offset_px * own.normal;
  const int rival = descend(strip.stations, neighbour, p);
  const Station& other = strip.stations[static_cast<std::size_t>(rival)];
  if (neighbours.along(own, other) < apart_px(strip)) return;
  if ((p - other.point_px).norm() > kCoverWidths * strip.width_px + 0.5F) return;
  reading.rival = rival;
  reading.rival_offset_px = (p - other.point_px).dot(other.normal);
}

/// Every pixel of a sparse cloud, once for each strand that covers it.
void read_scattered(const evidence::Cloud& cloud, const Image& image, const Neighbours& neighbours,
                    Strip& strip) {
  strip.readings.clear();
  const float reach = kCoverWidths * strip.width_px + 0.5F;
  for (std::size_t k = 0; k < cloud.pixels.size(); ++k) {
    if (!geometry::measured(cloud.points_cam[k].z)) continue;
    const Vector2f p = image.centre(cloud.pixels[k]);
    int nearest = -1;
    float least = reach * reach;
    for (int i = 0; i < static_cast<int>(strip.stations.size()); ++i) {
      const float squared =
          (strip.stations[static_cast<std::size_t>(i)].point_px - p).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      nearest = i;
    }
    if (nearest < 0) continue;
    const Station& own = strip.stations[static_cast<std::size_t>(nearest)];
    Reading reading{nearest, (p - own.point_px).dot(own.normal), cloud.points_cam[k].z, -1, 0};
    find_rival(neighbours, strip, reading);
    strip.readings.push_back(reading);
    if (reading.rival < 0) continue;
    strip.readings.push_back(
        {reading.rival, reading.rival_offset_px, reading.depth_m, nearest, reading.offset_px});
  }
  std::sort(strip.readings.begin(), strip.readings.end(),
            [](const Reading& a, const Reading& b) { return a.station < b.station; });
}

}  // namespace

Strip make_strip(std::span<const Vector2f> path_px, float width_px, const Frame& frame,
                 const evidence::Cloud& cloud) {
  Strip strip;
  strip.width_px = width_px;
  strip.stations = place_stations(path_px, width_px, frame.intrinsics);
  strip.step_px = strip.stations[1].arclength_px - strip.stations[0].arclength_px;
  const Image image(frame);
  for (int i = 0; i < static_cast<int>(strip.stations.size()); ++i) {
    read_across(i, width_px, image, strip);
  }
  const Neighbours neighbours(strip, kNearWidths * width_px + 1);
  find_neighbours(neighbours, strip);
  if (cloud.pixels.size() <= kScattered) {
    read_scattered(cloud, image, neighbours, strip);
  } else {
    for (Reading& reading : strip.readings) find_rival(neighbours, strip, reading);
  }
  return strip;
}

}  // namespace flowdlo::prior
