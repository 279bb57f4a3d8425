#include "estimator/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/field_trial.hpp"
#include "estimator/known_scene.hpp"
#include "field/network.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::estimator {
namespace {

constexpr float kTolerance_m = 1e-4F;

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
                    .image_pixels = frame.width * frame.height}});
  if (!sampler) return sampler.error();
  return sampler->sample(
      {.frame = frame, .cloud = cloud, .field = field, .draw_priors = {&scene.prior, 1}});
}

/// The strand field's network on both, of noise for weights.
Verdict field_test(const flow::ProgramFactory& device) {
  constexpr weights::FieldSizes kSmall{.fine = 16, .middle = 16, .coarse = 16};
  const auto noise =
      std::make_shared<const weights::FieldWeights>(weights::seeded_field(kSmall, 1));
  auto there = field::Network::create(noise, device);
  if (!there) return {false, there.error().message};
  auto here = field::Network::create(noise, [] { return reference::create_program(1); });
  if (!here) return {false, "the CPU back end failed: " + here.error().message};
  const auto trial = try_field(*there, *here);
  if (!trial) return {false, trial.error().message};
  return {trial->agrees(), fmt::format("wrong numbers: the strand field's network differs from the "
                                       "CPU's by {:.2g} of its largest value",
                                       trial->difference)};
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
  if (passed) {
    if (const Verdict of_field = field_test(device); !of_field.passed) return of_field;
  }
  return {passed, fmt::format("{}: nodes differ from the CPU by at most {:.2g} mm",
                              passed ? "passed" : "wrong numbers", worst_m * 1e3F)};
}

}  // namespace flowdlo::estimator
