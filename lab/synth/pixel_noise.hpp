// PixelNoise: cheap random numbers for every pixel of an image, in any order.
#pragma once

#include <cmath>
#include <cstdint>

namespace flowdlo::synth {

class PixelNoise {
 public:
  explicit PixelNoise(std::uint32_t seed) : seed_(seed) {}

  /// An avalanche of shifts and odd multiplications; loops over it turn into vector code.
  [[nodiscard]] std::uint32_t word(std::uint32_t u, std::uint32_t v) const {
    std::uint32_t h = seed_ ^ (u * 0x9E3779B1U) ^ (v * 0x85EBCA77U);
    h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12U)) * 0x297A2D39U;
    return h ^ (h >> 15U);
  }
  /// In [0, 1).
  [[nodiscard]] float uniform(std::uint32_t u, std::uint32_t v) const {
    return static_cast<float>(static_cast<int>(word(u, v) >> 8U)) * 0x1.0p-24F;
  }
  /// Mean 0, deviation 1, never beyond 3.5: the sum of four bytes.
  [[nodiscard]] float bell(std::uint32_t u, std::uint32_t v) const {
    const std::uint32_t h = word(u, v);
    const std::uint32_t sum = (h & 255U) + ((h >> 8U) & 255U) + ((h >> 16U) & 255U) + (h >> 24U);
    return (static_cast<float>(static_cast<int>(sum)) - 510.0F) * (1.0F / 147.8F);
  }
  /// In [0, 1), smooth over `cell` pixels.
  [[nodiscard]] float smooth(float u, float v, float cell) const {
    const float x = u / cell + 1024.0F;
    const float y = v / cell + 1024.0F;
    const auto i = static_cast<std::uint32_t>(x);
    const auto j = static_cast<std::uint32_t>(y);
    const float s = ease(x - static_cast<float>(i));
    const float t = ease(y - static_cast<float>(j));
    const float top = (1 - s) * uniform(i, j) + s * uniform(i + 1, j);
    const float bottom = (1 - s) * uniform(i, j + 1) + s * uniform(i + 1, j + 1);
    return (1 - t) * top + t * bottom;
  }

 private:
  static float ease(float t) { return t * t * (3 - 2 * t); }

  std::uint32_t seed_;
};

}  // namespace flowdlo::synth
