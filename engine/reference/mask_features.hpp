// Local features phi_M(u_j), Sec. 3.4 and spec section 6. Twin of shaders/mask_features.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "ops/program.hpp"

namespace flowdlo::reference {

inline constexpr float kNearestDepth_m = 0.02F;    // spec section 6, feature 6
inline constexpr float kFeatureWidth_px = 640.0F;  // distances are pixels of an image this wide
inline constexpr float kFeatureScale_px = 100.0F;  // ... divided by this
inline constexpr float kFeatureLimit = 3.0F;       // ... and clamped
inline constexpr float kResidualLimit_m = 0.2F;    // Eq. (3.16)
inline constexpr float kResidualNear_m = 0.05F;    // Sec. 3.4, below Eq. (3.16)
inline constexpr float kResidualFar_m = 0.5F;

/// The four channels at half-resolution position (u, v), clamped to the field's border.
/// `texel(row, column)` gives std::array<float, 4>.
template <class Texel>
std::array<float, 4> bilinear(const Texel& texel, int width, int height, float u, float v) {
  // fmin and fmax, unlike clamp, turn a coordinate that is not a number into a border's.
  const float u_in = std::fmax(std::fmin(u, static_cast<float>(width - 1)), 0.0F);
  const float v_in = std::fmax(std::fmin(v, static_cast<float>(height - 1)), 0.0F);
  const int left = std::min(static_cast<int>(u_in), std::max(width - 2, 0));
  const int top = std::min(static_cast<int>(v_in), std::max(height - 2, 0));
  const int right = std::min(left + 1, width - 1);
  const int bottom = std::min(top + 1, height - 1);
  const float alpha = u_in - static_cast<float>(left);
  const float beta = v_in - static_cast<float>(top);
  const std::array<float, 4> top_left = texel(top, left);
  const std::array<float, 4> top_right = texel(top, right);
  const std::array<float, 4> bottom_left = texel(bottom, left);
  const std::array<float, 4> bottom_right = texel(bottom, right);
  std::array<float, 4> value{};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const float upper = top_left[channel] + alpha * (top_right[channel] - top_left[channel]);
    const float lower =
        bottom_left[channel] + alpha * (bottom_right[channel] - bottom_left[channel]);
    value[channel] = upper + beta * (lower - upper);
  }
  return value;
}

/// See ops::MaskFeatures. The field is whatever answers `texel(row, column)`, so that training can
/// read one that is never laid out in memory. `depth` is empty for six channels.
template <class Texel>
void mask_features_of(std::span<const float> state, std::span<const float> norm,
                      const ops::FrameParams& params, const Texel& texel,
                      std::span<const float> depth, std::span<float> out) {
  const int field_width = static_cast<int>(params.field_width);
  const int field_height = static_cast<int>(params.field_height);
  const float to_feature = kFeatureWidth_px / params.field_width / kFeatureScale_px;

  for (std::size_t row = 0; row * 4 < state.size(); ++row) {
    const float x = norm[3] * state[row * 4 + 0] + norm[0];
    const float y = norm[3] * state[row * 4 + 1] + norm[1];
    const float z = norm[3] * state[row * 4 + 2] + norm[2];
    const std::span<float> phi = out.subspan(row * 8, 8);
    std::fill(phi.begin(), phi.end(), 0.0F);
    if (!(z > kNearestDepth_m)) continue;

    const float u = params.fx * x / z + params.cx;
    const float v = params.fy * y / z + params.cy;
    const bool inside =
        u > -0.5F && u < params.width - 0.5F && v > -0.5F && v < params.height - 0.5F;
    const auto read = bilinear(texel, field_width, field_height,
                               (u + 0.5F) * params.field_width / params.width - 0.5F,
                               (v + 0.5F) * params.field_height / params.height - 0.5F);
    phi[0] = read[0];
    phi[1] = read[1];
    phi[2] = std::min(std::sqrt(read[2] * read[2] + read[3] * read[3]) * to_feature, kFeatureLimit);
    phi[3] = std::clamp(read[2] * to_feature, -kFeatureLimit, kFeatureLimit);
    phi[4] = std::clamp(read[3] * to_feature, -kFeatureLimit, kFeatureLimit);
    phi[5] = inside ? 1.0F : 0.0F;
    if (depth.empty() || !inside) continue;

    const int column =
        std::clamp(static_cast<int>(std::floor(u + 0.5F)), 0, static_cast<int>(params.width) - 1);
    const int line =
        std::clamp(static_cast<int>(std::floor(v + 0.5F)), 0, static_cast<int>(params.height) - 1);
    const float seen =
        depth[static_cast<std::size_t>(line) * static_cast<std::size_t>(params.width) + column];
    if (!(seen >= kResidualNear_m && seen <= kResidualFar_m)) continue;
    phi[6] = std::clamp(seen - z, -kResidualLimit_m, kResidualLimit_m) / kResidualLimit_m;
    phi[7] = 1.0F;  // Eq. (3.16)
  }
}

/// The same on a field in memory, [height, width, 4].
void mask_features(std::span<const float> state, std::span<const float> norm,
                   const ops::FrameParams& params, std::span<const float> field,
                   std::span<const float> depth, std::span<float> out);

}  // namespace flowdlo::reference
