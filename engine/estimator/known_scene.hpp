// KnownScene: a frame that needs no camera, for what has to be tried before the first one comes.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"
#include "prior/prior.hpp"

namespace flowdlo::estimator {

/// A wave of a rope across a small image: enough pixels that farthest-point sampling has to choose.
struct KnownScene {
  KnownScene();

  [[nodiscard]] Frame frame() const;

  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  Intrinsics camera{.fx = 150.0F, .fy = 150.0F, .cx = 79.5F, .cy = 59.5F};
  prior::Prior prior;
};

}  // namespace flowdlo::estimator
