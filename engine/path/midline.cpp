#include "path/midline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "path/region.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kTangentWidths = 1.5F;  // length over which a direction is fitted
constexpr float kTangentPx = 8.0F;
constexpr float kCurvatureWidths = 4.0F;  // length that tells a curvature
constexpr float kTightestWidths = 1.5F;   // radius of the tightest bend
constexpr float kMostReach = 0.8F;        // widths from the line to the mask's edge, at most
constexpr float kStepPx = 0.5F;

Vector2f normal_at(const Points& points, int i) {
  const int count = static_cast<int>(points.size());
  const Vector2f along = points[std::min(i + 3, count - 1)] - points[std::max(i - 3, 0)];
  if (along.norm() <= 0) return {0, 0};
  return Vector2f(-along.y(), along.x()).normalized();
}

float reach_of(const image::Mask& mask, const Vector2f& from, const Vector2f& direction,
               float most) {
  float reach = 0;
  while (reach < most && lit(mask, from + (reach + kStepPx) * direction)) reach += kStepPx;
  return reach;
}

}  // namespace

float length_of(const Points& points) {
  float sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

Points smoothed(Points points, int half) {
  const int count = static_cast<int>(points.size());
  Points next = points;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < count; ++i) {
      const int h = std::min({half, i, count - 1 - i});
      Vector2f sum{0, 0};
      for (int k = i - h; k <= i + h; ++k) sum += points[k];
      next[i] = sum / static_cast<float>(2 * h + 1);
    }
    std::swap(points, next);
  }
  return points;
}

void recentre(Points& points, const image::Mask& mask, float width_px) {
  const int count = static_cast<int>(points.size());
  if (count < 5) return;
  const float most = std::ceil(kMostReach * width_px) + 1;
  Points normals(points.size());
  std::vector<float> moves(points.size() + 1, 0.0F);    // running sums
  std::vector<float> weights(points.size() + 1, 0.0F);  // of those that count
  for (int i = 0; i < count; ++i) {
    normals[i] = normal_at(points, i);
    const float left = reach_of(mask, points[i], normals[i], most);
    const float right = reach_of(mask, points[i], -normals[i], most);
    const bool counts = left < most && right < most;
    moves[i + 1] = moves[i] + (counts ? 0.5F * (left - right) : 0);
    weights[i + 1] = weights[i] + (counts ? 1.0F : 0.0F);
  }
  const int half = std::max(2, static_cast<int>(0.5F * width_px));
  for (int i = 0; i < count; ++i) {
    const int low = std::max(0, i - half);
    const int high = std::min(count, i + half + 1);
    const float weight = weights[high] - weights[low];
    if (weight > 0) points[i] += (moves[high] - moves[low]) / weight * normals[i];
  }
}

Vector2f direction_at_front(const Points& points, float scale_px) {
  const int count = static_cast<int>(points.size());
  const int window =
      std::clamp(static_cast<int>(std::max(kTangentWidths * scale_px, kTangentPx)), 2, count);
  Vector2f mean{0, 0};
  for (int i = 0; i < window; ++i) mean += points[i];
  mean /= static_cast<float>(window);
  Vector2f slope{0, 0};  // least squares over the index
  for (int i = 0; i < window; ++i) {
    slope -= (points[i] - mean) * (static_cast<float>(i) - 0.5F * static_cast<float>(window - 1));
  }
  const float norm = slope.norm();
  if (norm > 0) return slope / norm;
  const Vector2f chord = points.front() - points.back();
  return chord.norm() > 0 ? Vector2f(chord.normalized()) : Vector2f(1, 0);
}

float curvature_at_front(const Points& points, float scale_px) {
  const int last = static_cast<int>(points.size()) - 1;
  const int reach = std::min(last, static_cast<int>(kCurvatureWidths * scale_px));
  if (reach < 4) return 0;
  const Vector2f& far = points[reach];
  const Vector2f& middle = points[reach / 2];
  const Vector2f in = middle - far;
  const Vector2f out = points.front() - middle;
  const float product = in.norm() * out.norm() * (in + out).norm();
  if (!(product > 0)) return 0;
  const float curvature = 2 * (in.x() * out.y() - in.y() * out.x()) / product;
  const float limit = 1 / (kTightestWidths * scale_px);
  const float known = static_cast<float>(reach) / (kCurvatureWidths * scale_px);
  return known * std::clamp(curvature, -limit, limit);
}

}  // namespace flowdlo::path
