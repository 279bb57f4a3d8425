#include "estimator/known_scene.hpp"

#include <cmath>
#include <numbers>

#include "geometry/camera.hpp"

namespace flowdlo::estimator {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr float kDepth_m = 0.4F;

int wave(float u) {
  return static_cast<int>(60.0F + 35.0F * std::sin(u / 140.0F * 3.0F * std::numbers::pi_v<float>));
}

}  // namespace

KnownScene::KnownScene() : depth_m(kWidth * kHeight, 0.0F), mask(kWidth * kHeight, 0) {
  for (int u = 10; u < 150; ++u) {
    const int centre = wave(static_cast<float>(u));
    for (int v = centre - 3; v <= centre + 3; ++v) {
      const auto pixel = static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
      mask[pixel] = 255;
      depth_m[pixel] = kDepth_m + 0.0005F * static_cast<float>(u % 7);
    }
  }
  for (std::size_t node = 0; node < kNodes; ++node) {
    const float u = 10.0F + 139.0F * static_cast<float>(node) / (kNodes - 1);
    prior.nodes[node] = geometry::unproject(camera, u, static_cast<float>(wave(u)), kDepth_m);
    prior.support[node] = node % 5 == 0 ? 0 : 1;
  }
}

Frame KnownScene::frame() const { return {kWidth, kHeight, camera, depth_m, mask, {}}; }

}  // namespace flowdlo::estimator
