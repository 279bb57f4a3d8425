#include "estimator/tensors.hpp"

#include "field/channel.hpp"

namespace flowdlo::estimator {
namespace {

void append(std::vector<float>& values, const Centerline& nodes) {
  for (const Point3& node : nodes) values.insert(values.end(), {node.x, node.y, node.z});
}

/// [H/2, W/2, 4] to [4, H/2, W/2].
std::vector<float> planes(const evidence::MaskField& field) {
  const std::size_t texels = field.texels.size() / 4;
  std::vector<float> values(field.texels.size());
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      values[channel * texels + i] = field.texels[i * 4 + channel];
    }
  }
  return values;
}

}  // namespace

Tensors collect_tensors(std::span<const float> source, const Conditions& conditions,
                        const Sampled& sampled) {
  const flow::Prediction& prediction = sampled.prediction;
  const evidence::MaskField& field = sampled.mask_field;
  const Hypothesis& best = conditions.hypotheses.front();
  Tensors tensors;
  tensors.draws = static_cast<int>(prediction.draws.size());
  tensors.field_width = field.width;
  tensors.field_height = field.height;
  for (std::size_t row = 0; row + 4 <= source.size(); row += 4) {
    tensors.source.insert(tensors.source.end(), {source[row], source[row + 1], source[row + 2]});
  }
  for (const Point3& point : prediction.visible.points_cam) {
    tensors.visible.insert(tensors.visible.end(), {point.x, point.y, point.z});
  }
  tensors.visible_valid.assign(prediction.visible.valid.begin(), prediction.visible.valid.end());
  for (const Eigen::Vector2f& sample : conditions.paths.ranked[best.path].points_px) {
    tensors.path.insert(tensors.path.end(), {sample.x(), sample.y()});
  }
  append(tensors.prior, best.prior.nodes);
  tensors.support.assign(best.prior.support.begin(), best.prior.support.end());
  for (const int hypothesis : sampled.assigned) {
    const auto& prior = conditions.hypotheses[static_cast<std::size_t>(hypothesis)].prior;
    append(tensors.draw_prior, prior.nodes);
    tensors.draw_support.insert(tensors.draw_support.end(), prior.support.begin(),
                                prior.support.end());
  }
  for (const Centerline& draw : prediction.draws) append(tensors.prediction, draw);
  tensors.mask_field = planes(field);
  return tensors;
}

SeenStrands seen_strands(const field::StrandField& seen) {
  const field::Region& region = seen.region;
  SeenStrands strands{.width = region.size.width,
                      .height = region.size.height,
                      .first_u = region.box.x,
                      .first_v = region.box.y,
                      .scale_u = region.scale.x(),
                      .scale_v = region.scale.y()};
  const auto pixels = static_cast<std::size_t>(region.size.area());
  strands.channels.resize(field::kChannels * pixels);
  std::size_t pixel = 0;
  for (int v = 0; v < region.size.height; ++v) {
    for (int u = 0; u < region.size.width; ++u, ++pixel) {
      const auto& from = seen.channels.at(v, u);
      for (std::size_t channel = 0; channel < field::kChannels; ++channel) {
        strands.channels[channel * pixels + pixel] = from[channel];
      }
    }
  }
  return strands;
}

}  // namespace flowdlo::estimator
