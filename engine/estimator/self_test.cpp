#include "estimator/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/camera.hpp"
#include "reference/program.hpp"

namespace flowdlo::estimator {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr float kTolerance_m = 1e-4F;

/// A wave of a rope across a small image: enough pixels that farthest-point sampling has to choose.
struct KnownScene {
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, 0.0F);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(kWidth * kHeight, 0);
  Intrinsics camera{.fx = 150.0F, .fy = 150.0F, .cx = 79.5F, .cy = 59.5F};
  prior::Prior prior;

  KnownScene() {
    constexpr float kDepth_m = 0.4F;
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

  [[nodiscard]] Frame frame() const { return {kWidth, kHeight, camera, depth_m, mask, {}}; }

 private:
  static int wave(float u) {
    return static_cast<int>(60.0F +
                            35.0F * std::sin(u / 140.0F * 3.0F * std::numbers::pi_v<float>));
  }
};

Result<flow::Prediction> predict(const flow::ProgramFactory& factory, const KnownScene& scene) {
  weights::Variant variant;
  variant.local_channels = 8;  // both kinds of local features
  variant.head_channels = 4;
  variant.normalization = weights::NormalizationKind::kFrame;
  variant.parameterization = ops::Parameterization::kPreconditioned;
  const Frame frame = scene.frame();
  const auto cloud = evidence::unproject(frame);
  const auto field = evidence::mask_field(frame);
  auto sampler = flow::Sampler::create(
      std::make_shared<const weights::Weights>(weights::seeded(variant, 1)), factory,
      {.draws = 1,
       .steps = 2,
       .seed = 1,
       .capacity = {.cloud_points = static_cast<int>(cloud.points_cam.size()),
                    .field_texels = field.width * field.height,
                    .image_pixels = kWidth * kHeight}});
  if (!sampler) return sampler.error();
  return sampler->sample(
      {.frame = frame, .cloud = cloud, .field = field, .draw_priors = {&scene.prior, 1}});
}

}  // namespace

Verdict self_test(const flow::ProgramFactory& device) {
  const KnownScene scene;
  const auto expected = predict([] { return reference::create_program(1); }, scene);
  if (!expected) return {false, "the CPU back end failed: " + expected.error().message};
  const auto got = predict(device, scene);
  if (!got) return {false, got.error().message};

  if (got->visible.points_cam != expected->visible.points_cam) {
    return {false, "wrong numbers: farthest-point sampling picks other points than the CPU"};
  }
  float worst_m = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const Eigen::Vector3f difference =
        geometry::to_eigen(got->draws[0][node]) - geometry::to_eigen(expected->draws[0][node]);
    const float distance = difference.norm();
    worst_m = std::isfinite(distance) ? std::max(worst_m, distance) : 1e9F;
  }
  const bool passed = worst_m <= kTolerance_m;
  return {passed, fmt::format("{}: nodes differ from the CPU by at most {:.2g} mm",
                              passed ? "passed" : "wrong numbers", worst_m * 1e3F)};
}

}  // namespace flowdlo::estimator
