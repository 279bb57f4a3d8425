// One frame's conditions for the sampler, made without the path room: a wave and a prior beside it.
#pragma once

#include <memory>
#include <stdexcept>

#include "evidence/mask_field.hpp"
#include "evidence/visible_points.hpp"
#include "flow/sampler.hpp"
#include "geometry/camera.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {

struct WaveConditions {
  explicit WaveConditions(int draws, int width = 320, int height = 240, float rope_px = 9.0F)
      : wave(width, height, rope_px),
        frame(wave.frame()),
        cloud(evidence::unproject(frame)),
        field(evidence::mask_field(frame)) {
    for (int draw = 0; draw < draws; ++draw) {
      prior::Prior prior;
      for (std::size_t node = 0; node < kNodes; ++node) {
        const float u =
            static_cast<float>(width) * (0.1F + 0.8F * static_cast<float>(node) / (kNodes - 1));
        const float v = static_cast<float>(height) * (0.5F + 0.02F * static_cast<float>(draw));
        prior.nodes[node] = geometry::unproject(wave.camera, u, v, 0.41F);
        prior.support[node] = (node + static_cast<std::size_t>(draw)) % 5 == 0 ? 0 : 1;
      }
      priors.push_back(prior);
    }
  }
  WaveConditions(const WaveConditions&) = delete;

  [[nodiscard]] flow::SampleInput input() const {
    return {.frame = frame, .cloud = cloud, .field = field, .draw_priors = priors};
  }
  [[nodiscard]] flow::Capacity capacity() const {
    return {.cloud_points = static_cast<int>(cloud.points_cam.size()),
            .field_texels = field.width * field.height,
            .image_pixels = frame.width * frame.height};
  }

  WaveFrame wave;
  Frame frame;
  evidence::Cloud cloud;
  evidence::MaskField field;
  std::vector<prior::Prior> priors;
};

/// Every variant that metadata can name: 3 x 2 x 2 x 2 x 2.
inline std::vector<weights::Variant> all_variants() {
  std::vector<weights::Variant> variants;
  for (const auto parameterization :
       {ops::Parameterization::kVelocity, ops::Parameterization::kDirect,
        ops::Parameterization::kPreconditioned}) {
    for (const int local_channels : {6, 8}) {
      for (const int head_channels : {3, 4}) {
        for (const bool visible_points : {true, false}) {
          for (const auto normalization :
               {weights::NormalizationKind::kGlobal, weights::NormalizationKind::kFrame}) {
            weights::Variant variant;
            variant.parameterization = parameterization;
            variant.local_channels = local_channels;
            variant.head_channels = head_channels;
            variant.visible_points = visible_points;
            variant.normalization = normalization;
            variants.push_back(variant);
          }
        }
      }
    }
  }
  return variants;
}

inline flow::Sampler make_sampler(const weights::Variant& variant,
                                  const flow::ProgramFactory& factory,
                                  const WaveConditions& conditions, int steps,
                                  std::uint64_t seed = 3) {
  auto weights = weights::seeded(variant, 5);
  weights.metadata.mean = {0.0F, 0.0F, 0.42F};
  weights.metadata.scale = 0.1F;
  auto sampler =
      flow::Sampler::create(std::make_shared<const weights::Weights>(std::move(weights)), factory,
                            {.draws = static_cast<int>(conditions.priors.size()),
                             .steps = steps,
                             .seed = seed,
                             .capacity = conditions.capacity()});
  if (!sampler) throw std::runtime_error(sampler.error().message);
  return *std::move(sampler);
}

}  // namespace flowdlo::testing
