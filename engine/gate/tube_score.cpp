#include "gate/tube_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "gate/tube_shape.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::gate {
namespace {

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kCellsAcross = 5;             // a rope's width
constexpr float kMostCells =
    1U << 21;                       // of a raster: 2 px a cell where ropes are thin in large frames
constexpr float kMargin = 2;        // of the region around the mask, in widths
constexpr float kMostWider = 3;     // a drawn radius, against half the mask's width
constexpr float kRim_px = 1.25F;    // the mask may reach this far beyond the tube,
constexpr float kRim = 0.25F;       // or this share of the radius
constexpr float kCore = 0.75F;      // of the radius: what has to lie on the mask
constexpr float kRidge = 0.6F;      // of the radius: where depths are compared
constexpr float kStrandGap = 7;     // radii along the rope between what counts as two strands
constexpr float kNearCrossing = 4;  // radii along the rope around an overlap
constexpr float kTolerance = 0.6F;  // of a depth, in radii; and times its noise:
constexpr float kNoiseTolerance = 2.5F;
constexpr float kMostRadius_m = 1;

float share(double part, double whole, float otherwise) {
  return whole > 0 ? static_cast<float>(std::clamp(part / whole, 0.0, 1.0)) : otherwise;
}

bool usable(const Centerline& nodes) {
  return geometry::all_finite(nodes) && std::all_of(nodes.begin(), nodes.end(), [](const auto& p) {
           return geometry::measured(p.z);
         });
}

/// Stretches of the tube near overlaps, by arclength in steps of a radius.
class NearCrossings {
 public:
  NearCrossings(const TubeRaster& raster, float length_m, float radius_m)
      : step_m_(std::max(radius_m, length_m / kMostSteps)),
        near_(static_cast<std::size_t>(length_m / step_m_) + 1, 0) {
    const int reach = static_cast<int>(std::ceil(kNearCrossing * radius_m / step_m_));
    std::vector<std::uint8_t> overlaps(near_.size(), 0);
    for (const TubeCell& cell : raster.covered()) {
      if (!cell.back.here() || cell.back.off_axis > kCore || cell.front.off_axis > kCore) continue;
      overlaps[at(cell.front.arclength_m)] = 1;
      overlaps[at(cell.back.arclength_m)] = 1;
    }
    for (int i = 0; i < static_cast<int>(near_.size()); ++i) {
      if (overlaps[static_cast<std::size_t>(i)] == 0) continue;
      const int last = std::min(static_cast<int>(near_.size()) - 1, i + reach);
      for (int k = std::max(0, i - reach); k <= last; ++k) near_[static_cast<std::size_t>(k)] = 1;
    }
  }

  [[nodiscard]] bool holds(float arclength_m) const { return near_[at(arclength_m)] != 0; }

 private:
  static constexpr float kMostSteps = 4096;

  [[nodiscard]] std::size_t at(float arclength_m) const {
    return std::min(near_.size() - 1, static_cast<std::size_t>(arclength_m / step_m_));
  }

  float step_m_;
  std::vector<std::uint8_t> near_;
};

struct Tally {
  double explained = 0;
  double tube = 0;
  double doubled = 0;
  double hidden = 0;
  double on_mask = 0;
  double depths = 0;
  double agreeing = 0;
  double bias = 0;
  double crossing_depths = 0;
  double crossing_agreeing = 0;
};

/// Finite, and as wide as ropes are.
float usual_width_px(float rope_width_px) {
  return std::isfinite(rope_width_px) ? std::clamp(rope_width_px, 1.0F, 400.0F) : 1.0F;
}

}  // namespace

float pixel_m(const Centerline& nodes, const Intrinsics& camera) {
  std::vector<float> depths;
  for (const Point3& node : nodes) {
    if (geometry::measured(node.z)) depths.push_back(node.z);
  }
  if (depths.empty()) return 0;
  return geometry::median_of(depths) / (0.5F * (camera.fx + camera.fy));
}

float tube_radius_m(const Centerline& nodes, const Intrinsics& camera, float rope_width_px) {
  return std::min(kMostRadius_m, 0.5F * usual_width_px(rope_width_px) * pixel_m(nodes, camera));
}

TubeView::TubeView(const Frame& frame, float rope_width_px)
    : frame_(frame),
      rope_width_px_(usual_width_px(rope_width_px)),
      stride_px_(std::max(1, static_cast<int>(rope_width_px_ / kCellsAcross))) {
  const image::Rect mask = geometry::mask_box(frame);
  if (mask.empty()) return;
  find_region(mask);
  while (static_cast<float>(width_) * static_cast<float>(height_) > kMostCells) {
    ++stride_px_;
    find_region(mask);
  }
  measure_mask();
}

/// The cells that hold the mask and a margin.
void TubeView::find_region(const image::Rect& mask) {
  const int margin = static_cast<int>(kMargin * rope_width_px_) + 2;
  left_px_ = std::max(0, mask.x - margin);
  top_px_ = std::max(0, mask.y - margin);
  const int right = std::min(frame_.width - 1, mask.x + mask.width - 1 + margin);
  const int bottom = std::min(frame_.height - 1, mask.y + mask.height - 1 + margin);
  width_ = (right - left_px_) / stride_px_ + 1;
  height_ = (bottom - top_px_) / stride_px_ + 1;
}

std::size_t TubeView::pixel_of(int column, int row) const {
  return static_cast<std::size_t>(top_px_ + row * stride_px_) *
             static_cast<std::size_t>(frame_.width) +
         static_cast<std::size_t>(left_px_ + column * stride_px_);
}

bool TubeView::masked(std::size_t pixel) const { return frame_.mask[pixel] > kMaskThreshold; }

/// 0: none.
float TubeView::depth_m(std::size_t pixel) const {
  const float depth = frame_.depth_m[pixel];
  return geometry::measured(depth) ? depth : 0;
}

/// How many cells it has, and the deviation of its depths from the median difference of neighbours.
void TubeView::measure_mask() {
  std::vector<float> steps;
  for (int row = 0; row < height_; ++row) {
    const std::size_t first = pixel_of(0, row);
    const std::uint8_t* const mask = frame_.mask.data() + first;
    const int last_px = (width_ - 1) * stride_px_;
    int before_px = -1 - stride_px_;  // the cell of the mask to the left
    for (int u = geometry::first_masked(mask, 0, last_px + 1); u <= last_px;
         u = geometry::first_masked(mask, u + 1, last_px + 1)) {
      if (u % stride_px_ != 0) continue;
      masked_ += 1;
      if (u - before_px == stride_px_) {
        const float left_m = depth_m(first + static_cast<std::size_t>(before_px));
        const float right_m = depth_m(first + static_cast<std::size_t>(u));
        if (left_m > 0 && right_m > 0) steps.push_back(std::abs(left_m - right_m));
      }
      before_px = u;
    }
  }
  if (steps.empty()) return;
  noise_m_ = 1.05F * geometry::median_of(steps);  // median of |a - b| is 0.954 deviations
}

float TubeView::radius_m(const Centerline& nodes) const {
  return tube_radius_m(nodes, frame_.intrinsics, rope_width_px_);
}

void TubeView::compare(const std::vector<TubePoint>& tube, float radius_m, TubeScore& score) {
  const auto stride = static_cast<float>(stride_px_);
  const float rim_cells = std::max(kRim_px, kRim * 0.5F * rope_width_px_) / stride;
  raster_->draw(tube, radius_m, rim_cells, kStrandGap * radius_m);
  const NearCrossings near(*raster_, tube.back().arclength_m, radius_m);
  const float tolerance_m = kTolerance * radius_m + kNoiseTolerance * noise_m_;
  Tally tally;
  for (const TubeCell& cell : raster_->covered()) {
    const std::size_t pixel = pixel_of(cell.column, cell.row);
    const bool on_mask = masked(pixel);
    const float measured_m = depth_m(pixel);
    tally.explained += on_mask ? 1 : 0;
    const bool back = cell.back.here() && cell.back.off_axis <= kCore;
    if (cell.front.off_axis <= kCore || back) {
      // Behind something else, or where nothing was measured: the mask cannot tell.
      const bool hidden = !on_mask && measured_m < cell.front.surface_m - tolerance_m - radius_m;
      tally.tube += 1;
      tally.hidden += hidden ? 1 : 0;
      tally.on_mask += on_mask ? 1 : 0;
      tally.doubled += back && cell.front.off_axis <= kCore ? 1 : 0;
    }
    if (!on_mask || measured_m <= 0 || cell.front.off_axis > kRidge) continue;
    const float off = (measured_m - cell.front.surface_m) / tolerance_m;
    const bool agrees = std::abs(off) <= 1;
    tally.depths += 1;
    tally.agreeing += agrees ? 1 : 0;
    tally.bias += std::clamp(static_cast<double>(off), -1.0, 1.0);
    if (!near.holds(cell.front.arclength_m)) continue;
    tally.crossing_depths += 1;
    tally.crossing_agreeing += agrees ? 1 : 0;
  }
  const double outside = cells_outside(tube, width_, height_);
  score.mask_recall = share(tally.explained, masked_, 0);
  score.mask_precision = share(tally.on_mask, tally.tube + outside - tally.hidden, 0);
  score.hidden_share = share(tally.hidden, tally.tube + outside, 0);
  score.depth_agreement = share(tally.agreeing, tally.depths, 0);
  score.depth_bias = tally.depths > 0 ? static_cast<float>(tally.bias / tally.depths) : 0;
  score.crossing_agreement = share(tally.crossing_agreeing, tally.crossing_depths, 1);
  score.overlap_share = share(tally.doubled, tally.tube, 1);
}

TubeScore TubeView::score(const Centerline& nodes, float radius_m) {
  if (!usable(nodes) || !(radius_m > 0 && radius_m <= kMostRadius_m) || width_ == 0) return {};
  const Intrinsics& camera = frame_.intrinsics;
  const auto stride = static_cast<float>(stride_px_);
  std::vector<TubePoint> tube = smooth_tube(nodes);
  const float most_cells = kMostWider * 0.5F * rope_width_px_ / stride;
  for (TubePoint& point : tube) {
    const float x = camera.fx * point.cam.x() / point.depth_m + camera.cx;
    const float y = camera.fy * point.cam.y() / point.depth_m + camera.cy;
    point.cell = {(x - static_cast<float>(left_px_)) / stride,
                  (y - static_cast<float>(top_px_)) / stride};
    if (!point.cell.allFinite() || point.cell.cwiseAbs().maxCoeff() > kFarthestCell) return {};
    point.radius_cells =
        std::clamp(radius_m * camera.fx / point.depth_m / stride, 1e-3F, most_cells);
  }
  if (!std::isfinite(tube.back().arclength_m)) return {};
  if (!raster_) raster_.emplace(width_, height_);
  TubeScore score;
  compare(tube, radius_m, score);
  measure_crossings(tube, radius_m, score);
  measure_bends(nodes, radius_m, score);
  return score;
}

}  // namespace flowdlo::gate
