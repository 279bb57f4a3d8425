#include "synth/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::synth {
namespace {

constexpr double kNearest_m = 0.02;

void mark(const Vector2d& low_px, const Vector2d& high_px, Blocks& blocks) {
  const auto block = [](double px, int count) {
    return static_cast<int>(std::clamp(std::floor(px / kBlock_px), -1.0, count * 1.0));
  };
  const int left = std::max(0, block(low_px.x(), blocks.columns));
  const int right = std::min(blocks.columns - 1, block(high_px.x(), blocks.columns));
  const int top = std::max(0, block(low_px.y(), blocks.rows));
  const int bottom = std::min(blocks.rows - 1, block(high_px.y(), blocks.rows));
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      blocks.wanted[static_cast<std::size_t>(row * blocks.columns + column)] = 1;
    }
  }
}

void mark_ball(const View& view, const Vector3d& middle, double radius_m, Blocks& blocks) {
  const double nearest = middle.z() - radius_m;
  if (nearest < kNearest_m) {
    if (middle.z() + radius_m > kNearest_m)
      std::fill(blocks.wanted.begin(), blocks.wanted.end(), 1);
    return;
  }
  const Vector2d at = view.project(middle);
  // Towards the image's border a ball's outline is wider than f r / z.
  const double slant = std::hypot(middle.x(), middle.y()) / middle.z();
  const double reach = radius_m * view.camera.fx / nearest * std::sqrt(1 + slant * slant) + 1.5;
  mark(at.array() - reach, at.array() + reach, blocks);
}

void mark_capsule(const View& view, const Capsule& capsule, Blocks& blocks) {
  const Vector3d d = capsule.to - capsule.from;
  const int steps = std::max(1, static_cast<int>(std::ceil(2 * d.norm() / capsule.radius_m)));
  for (int k = 0; k <= steps; ++k) {
    mark_ball(view, capsule.from + d * k / steps, 1.1 * capsule.radius_m, blocks);
  }
}

void mark_box(const View& view, const Box& box, Blocks& blocks) {
  Vector2d low(1e9, 1e9);
  Vector2d high(-1e9, -1e9);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Vector3d p = box.middle + box.axes * sign.cwiseProduct(box.half_m);
    if (p.z() < kNearest_m) {
      std::fill(blocks.wanted.begin(), blocks.wanted.end(), 1);
      return;
    }
    low = low.cwiseMin(view.project(p));
    high = high.cwiseMax(view.project(p));
  }
  mark(low.array() - 1.0, high.array() + 1.0, blocks);
}

// A long thin box slants across the image: its bounding rectangle would be most of it.
void mark_long_box(const View& view, const Box& box, Blocks& blocks) {
  const int pieces = std::max(1, static_cast<int>(box.half_m.x() / (box.half_m.y() + 0.01)));
  for (int k = 0; k < pieces; ++k) {
    Box piece = box;
    piece.half_m.x() /= pieces;
    piece.middle += box.axes.col(0) * piece.half_m.x() * (2 * k + 1 - pieces);
    mark_box(view, piece, blocks);
  }
}

}  // namespace

Blocks blocks_of(const View& view, std::span<const Rope> ropes, std::span<const Thing> things) {
  Blocks blocks;
  blocks.columns = (view.sensor->width + kBlock_px - 1) / kBlock_px;
  blocks.rows = (view.sensor->height + kBlock_px - 1) / kBlock_px;
  blocks.wanted.assign(static_cast<std::size_t>(blocks.columns * blocks.rows), 0);
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    const auto& points = view.curves[k].points;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      mark_ball(view, points[i], 1.25 * ropes[k].radius_m, blocks);
    }
  }
  for (const Thing& thing : things) {
    for (const Capsule& capsule : thing.capsules) mark_capsule(view, capsule, blocks);
    for (const Box& box : thing.boxes) mark_long_box(view, box, blocks);
  }
  return blocks;
}

}  // namespace flowdlo::synth
