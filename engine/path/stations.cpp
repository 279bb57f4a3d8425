#include "path/stations.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/quantile.hpp"
#include "path/cover.hpp"
#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using geometry::quantile;
using Points = std::vector<Vector2f>;

constexpr int kCalmSamples = 4;
constexpr float kRunWidths = 3.0F;   // a narrow part is at least this long,
constexpr float kRunSpread = 1.25F;  // even,
constexpr float kHalfLeast = 0.42F;  // and between these shares of the usual width
constexpr float kHalfMost = 0.78F;
constexpr double kRoundPx2 = 0.01;   // what rounding adds to squared residuals
constexpr float kThinPx = 2.0F;      // of ropes thinner than this distances to the edge tell little
constexpr float kUsualShare = 1.5F;  // of the narrow parts' width: usual up to this
constexpr float kSingleShare = 1.3F;    // of the narrow parts' width: one strand up to this
constexpr float kFewestNarrow = 0.04F;  // share of the stations that are one strand

Line measured(const Segment& segment, const Region& region, float width_px) {
  const image::Mask& mask = region.mask;
  const int half = std::clamp(static_cast<int>(std::lround(0.5F * width_px)), 2, 12);
  const Points points = smoothed(segment.points_px, half);
  const int last = static_cast<int>(points.size()) - 1;
  const float most = kMostScan * width_px + 2;
  Line line;
  for (int i = 0; i <= last; ++i) {
    const Vector2f along = points[std::min(i + half, last)] - points[std::max(i - half, 0)];
    line.push_back(across(mask, points[i], along, most));
  }
  return line;
}

// Running medians over 2 `half` + 1 values or a sample of them; zeros do not count.
std::vector<float> calmed(const std::vector<float>& values, int half) {
  std::vector<float> result;
  std::vector<float> window;
  const int count = static_cast<int>(values.size());
  const int step = std::max(1, half / kCalmSamples);
  for (int i = 0; i < count; ++i) {
    window.clear();
    for (int k = std::max(0, i - half); k <= std::min(count - 1, i + half); k += step) {
      if (values[k] > 0) window.push_back(values[k]);
    }
    result.push_back(window.empty() ? 0 : quantile(window, 0.5F));
  }
  return result;
}

// Whether an occluder ends the mask to a side of the station.
bool hidden(const Station& station, const Cover& cover, float depth_m, float width_px) {
  if (depth_m <= 0) return false;
  const float most = kMostScan * width_px + 2;
  return cover.beyond(station.middle_px, station.normal, depth_m, most) == Sight::kHidden ||
         cover.beyond(station.middle_px, -station.normal, depth_m, most) == Sight::kHidden;
}

// Frays and single pixels leave the widths, noise and holes the depths.
void calm(std::vector<Line>& lines, const Cover& cover, float width_px) {
  const int half = std::max(2, static_cast<int>(0.75F * width_px));
  const int step = std::max(1, half / kCalmSamples);
  std::vector<std::vector<float>> depths;
  std::vector<float> all;
  for (Line& line : lines) {
    std::vector<float> widths;
    std::vector<float> depth;
    for (const Station& station : line) {
      widths.push_back(station.width_px);
      depth.push_back(cover.rope_depth(station.middle_px));
    }
    widths = calmed(widths, half);
    depth = calmed(depth, 4 * half);
    for (std::size_t i = 0; i < line.size(); ++i) {
      line[i].width_px = widths[i];
      if (depth[i] > 0) all.push_back(depth[i]);
    }
    depths.push_back(std::move(depth));
  }
  const float usual_m = all.empty() ? 0 : quantile(all, 0.5F);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    float before = usual_m;
    for (std::size_t i = 0; i < lines[l].size(); ++i) {
      Station& station = lines[l][i];
      if (depths[l][i] > 0) before = depths[l][i];
      if (usual_m > 0) {
        station.nearer = std::clamp(usual_m / before, 1 / kNearerMost, kNearerMost);
      }
      station.size_px = station.width_px / station.nearer;
      station.whole = i % static_cast<std::size_t>(step) == 0
                          ? !hidden(station, cover, before, width_px)
                          : lines[l][i - 1].whole;
    }
  }
}

// The size that a line keeps between two stations, whole ones; 0 where it is not
// even.
float even(const Line& line, std::size_t first, std::size_t length) {
  std::vector<float> sizes;
  for (std::size_t k = first; k < first + length; ++k) {
    if (!line[k].whole) return 0;
    sizes.push_back(line[k].size_px);
  }
  const float high = quantile(sizes, 0.85F);
  return high <= kRunSpread * quantile(sizes, 0.15F) ? high : 0;
}

// The least size that a line keeps for some way, `usual_px` at most.
float least_kept(const std::vector<Line>& lines, float usual_px) {
  float least = usual_px;
  const auto length = static_cast<std::size_t>(std::max(6.0F, kRunWidths * usual_px));
  const std::size_t step = std::max<std::size_t>(1, length / 6);
  for (const Line& line : lines) {
    for (std::size_t i = 0; i + length <= line.size(); i += step) {
      const float size = even(line, i, length);
      if (size > 0) least = std::min(least, size);
    }
  }
  return least;
}

// The median of what is not much wider than the narrow parts; 0 without any.
float usual_size(const std::vector<Line>& lines) {
  std::vector<float> sizes;
  for (const Line& line : lines) {
    for (const Station& station : line) {
      if (station.whole) sizes.push_back(station.size_px);
    }
  }
  if (sizes.empty()) return 0;
  const float most = kUsualShare * quantile(sizes, 0.2F);
  std::erase_if(sizes, [&](float size) { return size > most; });
  return sizes.empty() ? 0 : quantile(sizes, 0.5F);
}

}  // namespace

float reach(const image::Mask& mask, const Vector2f& p, const Vector2f& direction, float most_px) {
  float walked = 1;
  while (walked < most_px && lit(mask, p + walked * direction)) walked += 1;
  walked -= 1 - kScanStepPx;
  while (walked < most_px && lit(mask, p + walked * direction)) walked += kScanStepPx;
  return walked - 0.5F * kScanStepPx;
}

Station across(const image::Mask& mask, const Vector2f& p, const Vector2f& along, float most_px) {
  Station station{p};
  if (along.norm() <= 0) return station;
  station.normal = Vector2f(-along.y(), along.x()).normalized();
  const float left = reach(mask, p, station.normal, most_px);
  const float right = reach(mask, p, -station.normal, most_px);
  station.middle_px += 0.5F * (left - right) * station.normal;
  station.width_px = left + right;
  return station;
}

Aside step_aside(const Points& before, const Points& after, const Vector2f& left) {
  if (before.size() < 3 || after.size() < 3) return {};
  const Vector2f along(left.y(), -left.x());
  const auto rows = static_cast<Eigen::Index>(before.size() + after.size());
  Eigen::MatrixX4d terms(rows, 4);
  Eigen::VectorXd aside(rows);
  Eigen::Index row = 0;
  for (const Points* points : {&before, &after}) {
    for (const Vector2f& p : *points) {
      const Vector2f off = p - before.front();
      const double s = along.dot(off);
      terms.row(row) << 1, s, s * s, points == &after ? 1 : 0;
      aside(row++) = left.dot(off);
    }
  }
  const auto scale = terms.cwiseAbs().colwise().maxCoeff().eval();
  for (Eigen::Index c = 0; c < 4; ++c) terms.col(c) /= std::max(1e-9, scale(c));
  const Eigen::Vector4d fit = terms.colPivHouseholderQr().solve(aside);
  const double error = (terms * fit - aside).squaredNorm() / static_cast<double>(rows) + kRoundPx2;
  const Eigen::Matrix4d normal = terms.transpose() * terms;
  const double inverse = normal.ldlt().solve(Eigen::Vector4d::Unit(3))(3);
  if (!(inverse > 0) || !std::isfinite(fit(3))) return {};
  return {static_cast<float>(fit(3)), static_cast<float>(std::sqrt(error * inverse))};
}

float single_size(const std::vector<Line>& lines, float usual_px) {
  if (usual_px < kThinPx) usual_px = std::max(usual_px, usual_size(lines));
  float narrow = least_kept(lines, usual_px);
  if (narrow > kHalfMost * usual_px || narrow < kHalfLeast * usual_px) narrow = usual_px;
  std::vector<float> single;
  std::size_t all = 0;
  for (const Line& line : lines) {
    all += line.size();
    for (const Station& station : line) {
      if (station.whole && station.size_px <= kSingleShare * narrow) {
        single.push_back(station.size_px);
      }
    }
  }
  if (static_cast<float>(single.size()) < kFewestNarrow * static_cast<float>(all)) return 0;
  return single.empty() ? 0 : quantile(single, 0.5F);
}

std::vector<Line> stations_of(const Graph& graph, const Region& region, const Frame& frame) {
  std::vector<Line> lines;
  for (const Segment& segment : graph.segments) {
    lines.emplace_back();
    if (segment.alive) lines.back() = measured(segment, region, graph.width_px);
  }
  calm(lines, Cover(region, frame, graph.width_px), graph.width_px);
  return lines;
}

}  // namespace flowdlo::path
