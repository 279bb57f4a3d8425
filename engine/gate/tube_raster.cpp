#include "gate/tube_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace flowdlo::gate {
namespace {

constexpr float kNowhere_m = std::numeric_limits<float>::infinity();
constexpr Strand kAbsent{kNowhere_m, 0, 0};

/// The part of `from` to `to` (0 to 1) that comes within `reach` of row `row`; empty when first
/// exceeds second.
std::pair<float, float> part_near(float from, float to, float row, float reach) {
  const float step = to - from;
  if (std::abs(step) < 1e-6F) {
    return std::abs(row - from) <= reach ? std::pair{0.0F, 1.0F} : std::pair{1.0F, 0.0F};
  }
  const float a = (row - reach - from) / step;
  const float b = (row + reach - from) / step;
  return {std::max(0.0F, std::min(a, b)), std::min(1.0F, std::max(a, b))};
}

int cell_clamped(float value, int size) {
  return static_cast<int>(std::clamp(value, -1.0F, static_cast<float>(size)));
}

}  // namespace

bool Strand::here() const { return surface_m < kNowhere_m; }

TubeRaster::TubeRaster(int width, int height)
    : width_(width),
      height_(height),
      numbers_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

std::uint32_t& TubeRaster::number_at(int column, int row) {
  return numbers_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)];
}

/// Keeps the nearest surface of each of the two nearest strands.
void TubeRaster::put(int column, int row, const Strand& sample) {
  std::uint32_t& number = number_at(column, row);
  if (number == 0) {
    covered_.push_back({column, row, sample, kAbsent});
    number = static_cast<std::uint32_t>(covered_.size());
    return;
  }
  TubeCell& cell = covered_[number - 1];
  const auto same = [&](const Strand& strand) {
    return strand.here() && std::abs(strand.arclength_m - sample.arclength_m) <= strand_gap_m_;
  };
  const auto merge = [&](Strand& strand) {
    const float off_axis = std::min(strand.off_axis, sample.off_axis);
    if (sample.surface_m < strand.surface_m) strand = sample;
    strand.off_axis = off_axis;
  };
  if (same(cell.front)) {
    merge(cell.front);
  } else if (same(cell.back)) {
    merge(cell.back);
  } else if (sample.surface_m < cell.back.surface_m) {
    cell.back = sample;
  }
  if (cell.back.surface_m < cell.front.surface_m) std::swap(cell.front, cell.back);
}

void TubeRaster::draw_segment(const TubePoint& from, const TubePoint& to) {
  const Eigen::Vector2f along = to.cell - from.cell;
  const float squared = along.squaredNorm();
  const float reach = std::max(from.radius_cells, to.radius_cells) + rim_cells_;
  const auto [low, high] = std::minmax({from.cell.y(), to.cell.y()});
  const int first_row = std::max(0, cell_clamped(std::ceil(low - reach), height_));
  const int last_row = std::min(height_ - 1, cell_clamped(std::floor(high + reach), height_));
  for (int row = first_row; row <= last_row; ++row) {
    const auto y = static_cast<float>(row);
    const auto [begin, end] = part_near(from.cell.y(), to.cell.y(), y, reach);
    if (begin > end) continue;
    const auto [left, right] =
        std::minmax({from.cell.x() + begin * along.x(), from.cell.x() + end * along.x()});
    const int first = std::max(0, cell_clamped(std::ceil(left - reach), width_));
    const int last = std::min(width_ - 1, cell_clamped(std::floor(right + reach), width_));
    for (int column = first; column <= last; ++column) {
      const Eigen::Vector2f at(static_cast<float>(column), y);
      const float t =
          squared > 0 ? std::clamp((at - from.cell).dot(along) / squared, 0.0F, 1.0F) : 0.0F;
      const float radius = from.radius_cells + t * (to.radius_cells - from.radius_cells);
      const float distance_squared = (at - from.cell - t * along).squaredNorm();
      if (distance_squared > (radius + rim_cells_) * (radius + rim_cells_)) continue;
      const float off_axis = std::sqrt(distance_squared) / radius;
      const float bulge_m = radius_m_ * std::sqrt(std::max(0.0F, 1 - off_axis * off_axis));
      put(column, row,
          {from.depth_m + t * (to.depth_m - from.depth_m) - bulge_m,
           from.arclength_m + t * (to.arclength_m - from.arclength_m), off_axis});
    }
  }
}

void TubeRaster::draw(std::span<const TubePoint> points, float radius_m, float rim_cells,
                      float strand_gap_m) {
  radius_m_ = radius_m;
  rim_cells_ = rim_cells;
  strand_gap_m_ = strand_gap_m;
  for (const TubeCell& cell : covered_) number_at(cell.column, cell.row) = 0;
  covered_.clear();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) draw_segment(points[i], points[i + 1]);
}

}  // namespace flowdlo::gate
