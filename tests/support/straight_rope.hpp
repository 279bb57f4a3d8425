// StraightRope: a frame of one straight rope from left to right, and a curve along it.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"
#include "refine/strip.hpp"

namespace flowdlo::testing {

/// A rope of 10 px and 10 mm, half a metre away on a table that is one radius deeper than its axis;
/// what shows of it lies a radius nearer than its axis.
class StraightRope {
 public:
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 120;
  static constexpr float kAxis_m = 0.5F;
  static constexpr float kRadius_m = 0.005F;

  explicit StraightRope(float depth_offset_m = 0)
      : depth_m_(kWidth * kHeight, kAxis_m + kRadius_m), mask_(kWidth * kHeight, 0) {
    for (int v = 55; v < 65; ++v) {
      for (int u = 40; u < 280; ++u) {
        mask_[static_cast<std::size_t>(v * kWidth + u)] = 255;
        depth_m_[static_cast<std::size_t>(v * kWidth + u)] = kAxis_m - kRadius_m + depth_offset_m;
      }
    }
    for (std::size_t i = 0; i < kNodes; ++i) {
      const float u = 40 + 240 * static_cast<float>(i) / (kNodes - 1);
      curve_.nodes[i] = {(u - 160) * kAxis_m / 500, (59.5F - 60) * kAxis_m / 500, kAxis_m};
    }
    curve_.sigma_m.fill(1e-3F);
    curve_.radius_m = kRadius_m;
    curve_.pixel_m = 1e-3F;
    curve_.noise_m = 1e-4F;
  }

  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, {500, 500, 160, 60}, depth_m_, mask_, {}};
  }
  [[nodiscard]] refine::Curve curve() const { return curve_; }
  [[nodiscard]] std::vector<float>& depth_m() { return depth_m_; }

 private:
  std::vector<float> depth_m_;
  std::vector<std::uint8_t> mask_;
  refine::Curve curve_;
};

}  // namespace flowdlo::testing
