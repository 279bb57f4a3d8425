// Tracer: primary rays and shadow rays, by Embree. Ropes are round curves.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "flowdlo/result.hpp"
#include "synth/thing.hpp"
#include "synth/view.hpp"

namespace flowdlo::synth {

inline constexpr std::uint16_t kRopeThing = 0xFFFF;

/// What one pixel sees in front of the ground.
struct Surface {
  std::uint32_t pixel = 0;
  std::uint16_t thing = 0;  ///< index, or kRopeThing
  float z_m = 0;
  std::uint16_t rope = 0;   ///< of kRopeThing: which one
  std::uint8_t strand = 0;  ///< of a rope laid of several: which one
  float along = 0;          ///< of the rope: samples of its curve
  Eigen::Vector3f normal;   ///< unit, towards the camera
};

/// An ideal camera's picture.
struct Picture {
  std::vector<float> depth_m;      ///< [height, width], 0: nothing in reach
  std::vector<std::uint8_t> mask;  ///< [height, width], 255: rope
  std::vector<Surface> surfaces;   ///< rows of 4 x 4 blocks
};

class Tracer {
 public:
  /// `view` must outlive it. Fails with kInternal when Embree has no device or no memory.
  [[nodiscard]] static Result<Tracer> create(const View& view, std::span<const Rope> ropes,
                                             std::span<const Thing> things);

  [[nodiscard]] Picture take_picture() const;

  /// True when something lies between the point and the light; camera frame.
  [[nodiscard]] bool shadowed(const Eigen::Vector3f& point, const Eigen::Vector3f& light) const;

  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;
  ~Tracer();

 private:
  struct Impl;
  explicit Tracer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo::synth
