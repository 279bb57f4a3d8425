#include "field/rope_depth.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/quantile.hpp"
#include "image/blur.hpp"

namespace flowdlo::field {
namespace {

constexpr float kHalf = 0.5F;  // share of a pixel that makes it mask
constexpr int kCell_px = 16;   // of the grid on which the rope's depth is known
// What the cells around tell of it, three to each side: exact in binary.
const std::vector<float> kAround{0.03125F, 0.109375F, 0.21875F, 0.28125F,
                                 0.21875F, 0.109375F, 0.03125F};
constexpr float kFarWeight = 1e-4F;  // of the whole rope's depth, where no cell around has any
constexpr double kLevel = 0.03;      // cells squared of spread that a plane's slope is held to 0 by

/// Sums over the cells around each cell, by how near they lie: of weights, of places about the
/// grid's corner, and of depths.
class Moments {
 public:
  explicit Moments(const image::Size& cells) {
    for (auto& sum : sums_) sum = image::Image<float>(cells, 0.0F);
  }

  void set(const image::Point& cell, float count, float depth_m) {
    const auto x = static_cast<float>(cell.x);
    const auto y = static_cast<float>(cell.y);
    const float weighed_m = count * depth_m;
    const std::array values{count,           count * x,       count * y,
                            count * (x * x), count * (x * y), count * (y * y),
                            weighed_m,       weighed_m * x,   weighed_m * y};
    for (std::size_t k = 0; k < kSums; ++k) sums_[k].at(cell) = values[k];
  }

  void gather() {
    for (auto& sum : sums_) sum = image::blurred(sum, kAround, image::Beyond::kZero);
  }

  /// At a cell: of the plane that fits the cells around best, all but level where they do not tell
  /// its slope; `far_m` where there are none.
  [[nodiscard]] float plane_m(const image::Point& cell, float far_m) const {
    const float weight = sums_[0].at(cell);
    const auto w = static_cast<double>(weight + kFarWeight);
    std::array<double, 5> p{};  // x, y, xx, xy, yy
    std::array<double, 3> d{};  // z, xz, yz
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = static_cast<double>(sums_[1 + k].at(cell));
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = static_cast<double>(sums_[6 + k].at(cell));
    const double x = cell.x;  // sums about the corner become means about this cell
    const double y = cell.y;
    const auto known = static_cast<double>(weight);
    const double mx = (p[0] - known * x) / w;
    const double my = (p[1] - known * y) / w;
    const double xx = (p[2] - 2 * x * p[0] + known * x * x) / w - mx * mx + kLevel;
    const double xy = (p[3] - x * p[1] - y * p[0] + known * x * y) / w - mx * my;
    const double yy = (p[4] - 2 * y * p[1] + known * y * y) / w - my * my + kLevel;
    const double z = (d[0] + static_cast<double>(kFarWeight * far_m)) / w;
    const double xz = (d[1] - x * d[0]) / w - mx * z;
    const double yz = (d[2] - y * d[0]) / w - my * z;
    const double determinant = xx * yy - xy * xy;  // at least kLevel squared
    const double slope_x = (yy * xz - xy * yz) / determinant;
    const double slope_y = (xx * yz - xy * xz) / determinant;
    return static_cast<float>(z - slope_x * mx - slope_y * my);
  }

 private:
  // The weight; x, y, xx, xy and yy, weighed, in cells; z, xz and yz, weighed, in metres and cells.
  static constexpr std::size_t kSums = 9;
  std::array<image::Image<float>, kSums> sums_;
};

constexpr int kCells = kBlock_px / kCell_px;  // a side of a block

/// Depths of the mask in one cell of a block: `values`, unordered.
void collect_depths(const SeenPixel* cell, std::vector<float>& values) {
  values.clear();
  for (int v = 0; v < kCell_px; ++v) {
    for (int u = 0; u < kCell_px; ++u) {
      const SeenPixel& at = cell[v * kBlock_px + u];
      if (at[kSeenDepth] > 0 && at[kSeenMask] > kHalf) values.push_back(at[kSeenDepth]);
    }
  }
}

/// The cell before a pixel of a block, and the share of the one behind it.
std::pair<int, float> between(int block, int pixel) {
  const float place = (static_cast<float>(pixel) + 0.5F) / kCell_px + 0.5F;
  const auto first = static_cast<int>(place);
  return {kCells * block + first, place - static_cast<float>(first)};
}

}  // namespace

RopeDepth::RopeDepth(const NearSight& sight) {
  const auto cells_in = [](int px) { return (px + kCell_px - 1) / kCell_px; };
  const image::Size size = sight.pixels.size();
  const image::Size cells{cells_in(size.width) + 2, cells_in(size.height) + 2};  // one around
  Moments moments(cells);
  std::vector<float> all;
  std::vector<float> values;
  const auto& blocks = sight.pixels.map()->blocks;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (int k = 0; k < kCells * kCells; ++k) {
      const int column = k % kCells;
      const int row = k / kCells;
      const auto* const block = sight.pixels.block(i);
      collect_depths(block + kCell_px * (row * kBlock_px + column), values);
      if (values.empty()) continue;
      const float middle = geometry::median_of(values);
      all.push_back(middle);
      moments.set({kCells * blocks[i].x + column + 1, kCells * blocks[i].y + row + 1},
                  static_cast<float>(values.size()), middle);
    }
  }
  if (all.empty()) return;
  const float whole = geometry::median_of(all);
  moments.gather();
  coarse_m_ = image::Image<float>(cells);
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      coarse_m_.at(row, column) = moments.plane_m({column, row}, whole);
    }
  }
}

void RopeDepth::row_of(const image::Point& block, int v, float* row_m) const {
  const auto [top, t] = between(block.y, v);
  for (int u = 0; u < kBlock_px; ++u) {
    const auto [left, s] = between(block.x, u);
    const auto along = [&, left = left, s = s](int row) {
      return cell(row, left) * (1 - s) + cell(row, left + 1) * s;
    };
    row_m[u] = along(top) * (1 - t) + along(top + 1) * t;
  }
}

}  // namespace flowdlo::field
