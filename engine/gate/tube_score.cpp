#include "gate/tube_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gate/tube_shape.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::gate {
namespace {

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kCellsAcross = 5;  // a rope's width
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
    for (const std::uint32_t index : raster.covered()) {
      const TubeCell& cell = raster.cell(index);
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
    : camera_(frame.intrinsics),
      rope_width_px_(usual_width_px(rope_width_px)),
      stride_px_(std::max(1, static_cast<int>(rope_width_px_ / kCellsAcross))) {
  find_region(frame);
  while (static_cast<float>(width_) * static_cast<float>(height_) > kMostCells) {
    ++stride_px_;
    find_region(frame);
  }
  const auto cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  mask_.assign(cells, 0);
  depth_m_.assign(cells, 0);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto pixel = static_cast<std::size_t>(top_px_ + y * stride_px_) *
                             static_cast<std::size_t>(frame.width) +
                         static_cast<std::size_t>(left_px_ + x * stride_px_);
      const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x);
      mask_[cell] = frame.mask[pixel] > kMaskThreshold ? 1 : 0;
      const float depth = frame.depth_m[pixel];
      if (geometry::measured(depth)) depth_m_[cell] = depth;
    }
  }
  raster_ = TubeRaster(width_, height_);
  masked_ = static_cast<double>(std::count(mask_.begin(), mask_.end(), std::uint8_t{1}));
  noise_m_ = depth_noise_m();
}

/// The cells that hold the mask and a margin.
void TubeView::find_region(const Frame& frame) {
  int left = frame.width;
  int right = -1;
  int top = frame.height;
  int bottom = -1;
  for (int v = 0; v < frame.height; ++v) {
    const std::uint8_t* const row =
        frame.mask.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width);
    const auto lit = [](std::uint8_t value) { return value > kMaskThreshold; };
    const std::uint8_t* const first = std::find_if(row, row + frame.width, lit);
    if (first == row + frame.width) continue;
    int last = frame.width - 1;
    while (!lit(row[last])) --last;
    left = std::min(left, static_cast<int>(first - row));
    right = std::max(right, last);
    top = std::min(top, v);
    bottom = v;
  }
  if (right < 0) return;
  const int margin = static_cast<int>(kMargin * rope_width_px_) + 2;
  left_px_ = std::max(0, left - margin);
  top_px_ = std::max(0, top - margin);
  width_ = (std::min(frame.width - 1, right + margin) - left_px_) / stride_px_ + 1;
  height_ = (std::min(frame.height - 1, bottom + margin) - top_px_) / stride_px_ + 1;
}

/// A standard deviation, from the median difference of neighbours on the mask.
float TubeView::depth_noise_m() const {
  std::vector<float> steps;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x + 1 < width_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(x);
      if (mask_[i] == 0 || mask_[i + 1] == 0 || depth_m_[i] <= 0 || depth_m_[i + 1] <= 0) continue;
      steps.push_back(std::abs(depth_m_[i] - depth_m_[i + 1]));
    }
  }
  if (steps.empty()) return 0;
  return 1.05F * geometry::median_of(steps);  // median of |a - b| is 0.954 deviations
}

float TubeView::radius_m(const Centerline& nodes) const {
  return tube_radius_m(nodes, camera_, rope_width_px_);
}

void TubeView::compare(const std::vector<TubePoint>& tube, float radius_m, TubeScore& score) {
  const auto stride = static_cast<float>(stride_px_);
  const float rim_cells = std::max(kRim_px, kRim * 0.5F * rope_width_px_) / stride;
  raster_.draw(tube, radius_m, rim_cells, kStrandGap * radius_m);
  const NearCrossings near(raster_, tube.back().arclength_m, radius_m);
  const float tolerance_m = kTolerance * radius_m + kNoiseTolerance * noise_m_;
  Tally tally;
  for (const std::uint32_t i : raster_.covered()) {
    const TubeCell& cell = raster_.cell(i);
    const bool masked = mask_[i] != 0;
    tally.explained += masked ? 1 : 0;
    const bool back = cell.back.here() && cell.back.off_axis <= kCore;
    if (cell.front.off_axis <= kCore || back) {
      // Behind something else, or where nothing was measured: the mask cannot tell.
      const bool hidden = !masked && depth_m_[i] < cell.front.surface_m - tolerance_m - radius_m;
      tally.tube += 1;
      tally.hidden += hidden ? 1 : 0;
      tally.on_mask += masked ? 1 : 0;
      tally.doubled += back && cell.front.off_axis <= kCore ? 1 : 0;
    }
    if (!masked || depth_m_[i] <= 0 || cell.front.off_axis > kRidge) continue;
    const float off = (depth_m_[i] - cell.front.surface_m) / tolerance_m;
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
  if (!usable(nodes) || !(radius_m > 0 && radius_m <= kMostRadius_m) || mask_.empty()) return {};
  const auto stride = static_cast<float>(stride_px_);
  std::vector<TubePoint> tube = smooth_tube(nodes);
  const float most_cells = kMostWider * 0.5F * rope_width_px_ / stride;
  for (TubePoint& point : tube) {
    const float x = camera_.fx * point.cam.x() / point.depth_m + camera_.cx;
    const float y = camera_.fy * point.cam.y() / point.depth_m + camera_.cy;
    point.cell = {(x - static_cast<float>(left_px_)) / stride,
                  (y - static_cast<float>(top_px_)) / stride};
    if (!point.cell.allFinite() || point.cell.cwiseAbs().maxCoeff() > kFarthestCell) return {};
    point.radius_cells =
        std::clamp(radius_m * camera_.fx / point.depth_m / stride, 1e-3F, most_cells);
  }
  if (!std::isfinite(tube.back().arclength_m)) return {};
  TubeScore score;
  compare(tube, radius_m, score);
  measure_crossings(tube, radius_m, score);
  measure_bends(nodes, radius_m, score);
  return score;
}

}  // namespace flowdlo::gate
