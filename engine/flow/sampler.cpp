#include "flow/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "flow/gaussian_source.hpp"
#include "flow/velocity_model.hpp"
#include "guard/guarded.hpp"

namespace flowdlo::flow {
namespace {

constexpr int kParamsFloats = sizeof(ops::FrameParams) / sizeof(float);

ops::FrameParams frame_params(const SampleInput& input) {
  const Frame& frame = input.frame;
  const Point3 centroid = evidence::centroid(input.cloud);
  return {.fx = frame.intrinsics.fx,
          .fy = frame.intrinsics.fy,
          .cx = frame.intrinsics.cx,
          .cy = frame.intrinsics.cy,
          .width = static_cast<float>(frame.width),
          .height = static_cast<float>(frame.height),
          .field_width = static_cast<float>(input.field.width),
          .field_height = static_cast<float>(input.field.height),
          .point_count = static_cast<float>(input.cloud.points_cam.size()),
          .centroid_x = centroid.x,
          .centroid_y = centroid.y,
          .centroid_z = centroid.z,
          .reserved0 = 0,
          .reserved1 = 0,
          .reserved2 = 0,
          .reserved3 = 0};
}

Capacity needed(const SampleInput& input) {
  return {.cloud_points = static_cast<int>(input.cloud.points_cam.size()),
          .field_texels = input.field.width * input.field.height,
          .image_pixels = input.frame.width * input.frame.height};
}

}  // namespace

Sampler::Sampler(WeightsSource weights, ProgramFactory factory, const SamplerConfig& config)
    : weights_(std::move(weights)),
      factory_(std::move(factory)),
      config_(config),
      source_(gaussian_source(config.seed, config.draws)) {}

/// P_obs [256, 4] as the model reads it: sampled from the cloud, or written by the host.
ops::Tensor Sampler::declare_visible() {
  ops::Program& program = *program_;
  if (program.host_samples_points()) {
    handles_.cloud.reset();
    handles_.visible = program.input("visible", ops::kVisibleRows, 4);
    return handles_.visible;
  }
  handles_.cloud = program.input("cloud", std::max(config_.capacity.cloud_points, 1), 4);
  handles_.visible = program.output("visible", ops::kVisibleRows, 4);
  // The device reads it every step: it stays in its own memory and is copied out at the end.
  return program.scratch("visible", ops::kVisibleRows, 4);
}

Result<void> Sampler::build() {
  const auto weights = weights_();
  const auto& metadata = weights->metadata;
  variant_ = metadata.variant;
  const int rows = config_.draws * ops::kRowsPerDraw;
  program_ = factory_();
  ops::Program& program = *program_;

  handles_.params = program.input("params", 1, kParamsFloats);
  handles_.field = program.input("field", std::max(config_.capacity.field_texels, 1), 4);
  if (metadata.variant.local_channels == 8) {
    handles_.depth = program.input("depth", std::max(config_.capacity.image_pixels, 1), 1);
  }
  handles_.draw_prior = program.input("draw_prior", rows, 4);
  handles_.source = program.input("source", rows, 4);
  const auto visible = declare_visible();
  handles_.norm = program.output("norm", 1, 4);
  handles_.prediction = program.output("prediction", rows, 4);
  const auto state = program.scratch("state", rows, 4);
  const auto norm = program.scratch("norm", 1, 4);

  VelocityModel model(program, *weights, config_.draws, config_.steps);
  if (handles_.cloud) {
    program.stage("visible_points");
    program.record(ops::FarthestPoints{
        .cloud = *handles_.cloud, .params = handles_.params, .visible = visible});
  }
  program.stage("conditions");
  if (metadata.variant.normalization == weights::NormalizationKind::kFrame) {
    program.record(ops::FrameNormalization{.points = visible, .norm = norm});
  } else {
    const std::array<float, 4> global{metadata.mean[0], metadata.mean[1], metadata.mean[2],
                                      metadata.scale};
    program.record(ops::Copy{.from = program.constant("global_norm", 1, 4, global), .to = norm});
  }
  const Conditions conditions{.visible = visible,
                              .draw_prior = handles_.draw_prior,
                              .params = handles_.params,
                              .field = handles_.field,
                              .depth = handles_.depth,
                              .norm = norm};
  model.record_conditions(conditions);
  program.record(ops::Copy{.from = handles_.source, .to = state});
  for (int k = 0; k < config_.steps; ++k) model.record_step(conditions, state, k);
  program.stage("results");
  program.record(ops::Denormalize{.state = state, .norm = norm, .out = handles_.prediction});
  if (handles_.cloud) program.record(ops::Copy{.from = visible, .to = handles_.visible});
  program.record(ops::Copy{.from = norm, .to = handles_.norm});

  auto built = program.build();
  if (!built) return built;
  program.write(handles_.source, source_);
  built_ = true;
  return {};
}

Result<Sampler> Sampler::create(std::shared_ptr<const weights::Weights> weights,
                                ProgramFactory factory, const SamplerConfig& config) {
  return create([weights = std::move(weights)] { return weights; }, std::move(factory), config);
}

Result<Sampler> Sampler::create(WeightsSource weights, ProgramFactory factory,
                                const SamplerConfig& config) {
  Sampler sampler(std::move(weights), std::move(factory), config);
  auto built = sampler.build();
  if (!built) return built.error();
  return sampler;
}

Sampler Sampler::later(WeightsSource weights, ProgramFactory factory, const SamplerConfig& config) {
  return {std::move(weights), std::move(factory), config};
}

bool Sampler::fits(const Capacity& need) const {
  const Capacity& have = config_.capacity;
  const bool depth_fits = !handles_.depth || need.image_pixels <= have.image_pixels;
  const bool cloud_fits = !handles_.cloud || need.cloud_points <= have.cloud_points;
  return cloud_fits && need.field_texels <= have.field_texels && depth_fits;
}

Result<void> Sampler::ensure_capacity(const SampleInput& input) {
  const Capacity need = needed(input);
  if (built_ && fits(need)) return {};
  const Capacity have = config_.capacity;
  if (!fits(need)) {
    config_.capacity = {.cloud_points = std::max(need.cloud_points, have.cloud_points),
                        .field_texels = std::max(need.field_texels, have.field_texels),
                        .image_pixels = std::max(need.image_pixels, have.image_pixels)};
  }
  built_ = false;
  program_.reset();  // frees the old memory first
  auto built = guard::guarded("Sampler", [&] { return build(); });
  if (!built) config_.capacity = have;  // a frame of the size planned for may still find room
  return built;
}

void Sampler::write_cloud(const evidence::Cloud& cloud) {
  staging_.clear();
  for (const Point3& point : cloud.points_cam) {
    staging_.insert(staging_.end(), {point.x, point.y, point.z, 0.0F});
  }
  program_->write(*handles_.cloud, staging_);
}

void Sampler::write_visible(const evidence::VisiblePoints& visible) {
  visible_ = visible;
  staging_.clear();
  for (std::size_t i = 0; i < evidence::kVisiblePoints; ++i) {
    const Point3& point = visible.points_cam[i];
    staging_.insert(staging_.end(),
                    {point.x, point.y, point.z, static_cast<float>(visible.valid[i])});
  }
  program_->write(handles_.visible, staging_);
}

void Sampler::write(const SampleInput& input) {
  const ops::FrameParams params = frame_params(input);
  std::array<float, kParamsFloats> words{};
  std::memcpy(words.data(), &params, sizeof(params));
  program_->write(handles_.params, words);

  if (handles_.cloud) {
    write_cloud(input.cloud);
  } else {
    write_visible(input.visible != nullptr ? *input.visible
                                           : evidence::visible_points(input.cloud));
  }
  program_->write(handles_.field, input.field.texels);
  if (handles_.depth) program_->write(*handles_.depth, input.frame.depth_m);

  staging_.clear();
  for (const prior::Prior& prior : input.draw_priors) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      const Point3& point = prior.nodes[node];
      staging_.insert(staging_.end(),
                      {point.x, point.y, point.z, static_cast<float>(prior.support[node])});
    }
  }
  program_->write(handles_.draw_prior, staging_);
}

Prediction Sampler::read(int point_count) const {
  const auto draws = static_cast<std::size_t>(config_.draws);
  Prediction prediction;
  std::vector<float> rows(draws * kNodes * 4);
  program_->read(handles_.prediction, rows);
  std::array<float, 4> norm{};
  program_->read(handles_.norm, norm);

  const bool has_sigma = variant_.head_channels == 4;
  prediction.draws.resize(draws);
  if (has_sigma) prediction.sigma_m.resize(draws);
  for (std::size_t draw = 0; draw < draws; ++draw) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      const float* row = rows.data() + (draw * kNodes + node) * 4;
      prediction.draws[draw][node] = {row[0], row[1], row[2]};
      if (has_sigma) prediction.sigma_m[draw][node] = norm[3] * std::exp(row[3]);
    }
  }

  if (!handles_.cloud) {
    prediction.visible = visible_;
    return prediction;
  }
  std::vector<float> visible(static_cast<std::size_t>(ops::kVisibleRows) * 4);
  program_->read(handles_.visible, visible);
  for (std::size_t i = 0; i < evidence::kVisiblePoints; ++i) {
    prediction.visible.points_cam[i] = {visible[4 * i], visible[4 * i + 1], visible[4 * i + 2]};
    prediction.visible.valid[i] = visible[4 * i + 3] > 0.5F ? 1 : 0;
  }
  prediction.visible.count = std::min(point_count, evidence::kVisiblePoints);
  return prediction;
}

Result<Prediction> Sampler::sample(const SampleInput& input) {
  if (auto fits = ensure_capacity(input); !fits) return fits.error();
  write(input);
  if (auto ran = program_->run(); !ran) return ran.error();
  return read(static_cast<int>(input.cloud.points_cam.size()));
}

}  // namespace flowdlo::flow
