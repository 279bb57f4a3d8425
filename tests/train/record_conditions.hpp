// A record as the engine's sampler takes it.
#pragma once

#include <memory>
#include <vector>

#include "evidence/mask_field.hpp"
#include "flow/sampler.hpp"
#include "train/record.hpp"
#include "weights/weights.hpp"

namespace flowdlo::testing {

struct RecordConditions {
  explicit RecordConditions(const train::Record& record)
      : mask(train::image_of(record.mask)), depth(record.depth_m) {
    depth.resize(mask.size(), 0.0F);
    frame = {record.mask.width, record.mask.height, record.camera, depth, mask, {}};
    const auto& visible = record.visible;  // at most 256: sampled from, they come back as they are
    cloud.points_cam.assign(visible.points_cam.begin(), visible.points_cam.begin() + visible.count);
    cloud.pixels.assign(cloud.points_cam.size(), 0);
    field = evidence::mask_field(frame);
    prior::Prior prior;
    prior.nodes = record.priors.front().nodes;
    prior.support = record.priors.front().support;
    priors.push_back(prior);
  }
  RecordConditions(const RecordConditions&) = delete;

  [[nodiscard]] flow::SampleInput input() const {
    return {.frame = frame, .cloud = cloud, .field = field, .draw_priors = priors};
  }
  [[nodiscard]] Result<flow::Prediction> sample(const weights::Weights& weights,
                                                const flow::ProgramFactory& factory, int steps,
                                                std::uint64_t seed = 0) const {
    auto sampler = flow::Sampler::create(
        std::make_shared<const weights::Weights>(weights), factory,
        {.draws = 1,
         .steps = steps,
         .seed = seed,
         .capacity = {.cloud_points = static_cast<int>(cloud.points_cam.size()),
                      .field_texels = field.width * field.height,
                      .image_pixels = frame.width * frame.height}});
    if (!sampler) return sampler.error();
    return sampler->sample(input());
  }

  std::vector<std::uint8_t> mask;
  std::vector<float> depth;
  Frame frame;
  evidence::Cloud cloud;
  evidence::MaskField field;
  std::vector<prior::Prior> priors;
};

}  // namespace flowdlo::testing
