// S_M of Eq. (3.32): how much of a projected curve lies on the mask, dilated by a disc.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "gate/gate.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kMinDepth_m = 1e-6F;          // Sec. 3.2; nearer nodes have no projection
constexpr double kSamePlace_px = 1e-3;        // a sample this close to the next node is that node
constexpr double kMaxSegment_px = 1e9;        // longer ones have no sample of known position

/// Whether a pixel of a row is of the mask. Values above 127 are those whose highest bit is set, so
/// that the row's union tells, in many pixels at a time.
static_assert(kMaskThreshold == 127);
bool any_masked(std::span<const std::uint8_t> row) {
  std::uint8_t bits = 0;
  for (const std::uint8_t value : row) bits |= value;
  return bits > kMaskThreshold;
}

/// Hits and number of the one-pixel samples of a part of the curve.
struct Tally {
  double hits = 0;
  double samples = 0;
};

/// What one segment is compared with: the dilated mask of an image, looked at around single pixels,
/// since curves pass few of them.
struct Coverage {
  int width;
  int height;
  std::span<const std::uint8_t> mask;   // [height, width]
  const std::vector<int>& half_widths;  // of the disc, by rows from its centre

  /// Looked up at the nearest pixel; outside the image there is nothing.
  [[nodiscard]] bool at(const Eigen::Vector2d& position_px) const {
    const double u = std::floor(position_px.x() + 0.5);
    const double v = std::floor(position_px.y() + 0.5);
    if (!(u >= 0 && v >= 0 && u < width && v < height)) return false;
    return disc_meets_mask(static_cast<int>(u), static_cast<int>(v));
  }

  /// From the centre outwards: most of what is looked up lies on the mask.
  [[nodiscard]] bool disc_meets_mask(int u, int v) const {
    for (int away = 0; away < std::ssize(half_widths); ++away) {
      const int half_width = half_widths[static_cast<std::size_t>(away)];
      if (row_meets_mask(v - away, u, half_width)) return true;
      if (row_meets_mask(v + away, u, half_width)) return true;
    }
    return false;
  }

  [[nodiscard]] bool row_meets_mask(int v, int u, int half_width) const {
    if (v < 0 || v >= height) return false;
    const int first = std::max(0, u - half_width);
    const int last = std::min(width - 1, u + half_width);
    const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
    return any_masked(mask.subspan(row + static_cast<std::size_t>(first),
                                   static_cast<std::size_t>(last - first + 1)));
  }

  /// A segment that has no finite projection misses as often as the image's diagonal is long.
  [[nodiscard]] double diagonal_px() const { return std::ceil(std::hypot(width, height)); }
};

/// Narrows [begin, end], sample numbers, to where start + k * step lies in [-1, size]; false when
/// nothing is left.
bool clip(double start, double step, int size, double& begin, double& end) {
  if (std::abs(step) < 1e-12) return start >= -1 && start <= size;
  const double low = (-1 - start) / step;
  const double high = (size - start) / step;
  begin = std::max(begin, std::ceil(std::min(low, high)));
  end = std::min(end, std::floor(std::max(low, high)));
  return begin <= end;
}

/// Samples at 0, 1, 2, ... px from `from`, the far end excluded: it opens the next segment. At
/// least one. Only those near the image are visited, so that the work does not grow with the
/// length.
Tally walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Coverage& coverage) {
  const double length_px = (to - from).norm();
  if (!(length_px <= kMaxSegment_px)) return {0, coverage.diagonal_px()};
  Tally tally;
  tally.samples = std::max(1.0, std::ceil(length_px - kSamePlace_px));
  const Eigen::Vector2d step =
      length_px > 0 ? Eigen::Vector2d((to - from) / length_px) : Eigen::Vector2d(0, 0);
  double begin = 0;
  double end = tally.samples - 1;
  if (!clip(from.x(), step.x(), coverage.width, begin, end)) return tally;
  if (!clip(from.y(), step.y(), coverage.height, begin, end)) return tally;
  for (double k = begin; k <= end; ++k) tally.hits += coverage.at(from + k * step) ? 1 : 0;
  return tally;
}

bool in_front(const Point3& node) { return node.z > kMinDepth_m; }

Eigen::Vector2d project(const Intrinsics& camera, const Point3& node) {
  const Eigen::Vector3d point = geometry::to_eigen(node).cast<double>();
  return {static_cast<double>(camera.fx) * point.x() / point.z() + static_cast<double>(camera.cx),
          static_cast<double>(camera.fy) * point.y() / point.z() + static_cast<double>(camera.cy)};
}

}  // namespace

DilatedMask::DilatedMask(const Frame& frame, const Limits& limits)
    : width_(frame.width), height_(frame.height), mask_(frame.mask) {
  const float radius_px = limits.mask_dilation_px * geometry::pixel_scale(width_);
  for (int away = 0; away <= static_cast<int>(radius_px); ++away) {
    const auto away_px = static_cast<float>(away);
    half_widths_.push_back(static_cast<int>(std::sqrt(radius_px * radius_px - away_px * away_px)));
  }
}

float DilatedMask::agreement(const Centerline& nodes, const Intrinsics& camera) const {
  if (!geometry::all_finite(nodes)) return 0;
  const Coverage coverage{width_, height_, mask_, half_widths_};
  Tally total;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    Tally part{0, coverage.diagonal_px()};
    if (in_front(nodes[i]) && in_front(nodes[i + 1])) {
      part = walk(project(camera, nodes[i]), project(camera, nodes[i + 1]), coverage);
    }
    total.hits += part.hits;
    total.samples += part.samples;
  }
  const bool last_hits = in_front(nodes.back()) && coverage.at(project(camera, nodes.back()));
  total.hits += last_hits ? 1 : 0;
  total.samples += 1;
  return static_cast<float>(total.hits / total.samples);  // S_M, Eq. (3.32)
}

}  // namespace flowdlo::gate
