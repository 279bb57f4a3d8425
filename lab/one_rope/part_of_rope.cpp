#include "one_rope/part_of_rope.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace flowdlo::lab {
namespace {

using Eigen::Vector2f;

constexpr std::size_t kSamples = 1024;  // of the rope, for the nearest one

std::vector<Vector2f> samples_px(const FrameFolder& frame) {
  std::vector<Vector2f> samples;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double at = static_cast<double>(k) / (kSamples - 1) * (kNodes - 1);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kNodes - 2);
    const auto t = static_cast<float>(at - static_cast<double>(i));
    const Point3& a = (*frame.truth)[i];
    const Point3& b = (*frame.truth)[i + 1];
    const float z = (1 - t) * a.z + t * b.z;
    samples.emplace_back(frame.intrinsics.fx * ((1 - t) * a.x + t * b.x) / z + frame.intrinsics.cx,
                         frame.intrinsics.fy * ((1 - t) * a.y + t * b.y) / z + frame.intrinsics.cy);
  }
  return samples;
}

}  // namespace

FrameFolder part_of_rope(const FrameFolder& frame, double from, double to) {
  FrameFolder part = frame;
  const auto samples = samples_px(frame);
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      auto& lit = part.mask[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                            static_cast<std::size_t>(u)];
      if (lit == 0) continue;
      const Vector2f px(static_cast<float>(u), static_cast<float>(v));
      std::size_t nearest = 0;
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t k = 0; k < kSamples; ++k) {
        const float off = (samples[k] - px).squaredNorm();
        if (off >= least) continue;
        least = off;
        nearest = k;
      }
      const double share = static_cast<double>(nearest) / (kSamples - 1);
      if (share < from || share > to) lit = 0;
    }
  }
  return part;
}

}  // namespace flowdlo::lab
