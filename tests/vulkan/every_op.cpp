#include "vulkan/every_op.hpp"

#include <cstring>

#include "support/block_maps.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr int kDraws = 2;
constexpr int kRows = kDraws * ops::kRowsPerDraw;

std::vector<float> frame_params() {
  const ops::FrameParams params{.fx = 60,
                                .fy = 60,
                                .cx = 32,
                                .cy = 24,
                                .width = 64,
                                .height = 48,
                                .field_width = 32,
                                .field_height = 24,
                                .point_count = 700,
                                .centroid_x = 0,
                                .centroid_y = 0,
                                .centroid_z = 0,
                                .reserved0 = 0,
                                .reserved1 = 0,
                                .reserved2 = 0,
                                .reserved3 = 0};
  std::vector<float> values(16);
  std::memcpy(values.data(), &params, sizeof(params));
  return values;
}

/// Points to embedded, attended context.
ops::Tensor record_evidence(Trial& trial, ops::Tensor visible, ops::Tensor norm) {
  const auto points = trial->scratch("points", 256, 4);
  const auto hidden = trial->scratch("hidden", 256, 256);
  const auto key_value = trial->scratch("key_value", 256, 512);
  trial->record(ops::Normalize{.points = visible, .norm = norm, .out = points});
  trial->record(ops::Narrow{.x = points,
                            .layer = trial.layer(256, 3, 20),
                            .y = hidden,
                            .activation = ops::Activation::kGelu,
                            .first = {},
                            .second = {}});
  trial->record(
      ops::Linear{.x = hidden, .layer = trial.layer(512, 256, 30), .y = key_value, .residual = {}});
  return key_value;
}

struct Stream {
  ops::Tensor h;     // [rows, 256]
  ops::Tensor x;     // [rows, 256], normalised
  ops::Tensor gain;  // [1, 256]
  ops::Tensor shift;
};

void record_blocks(Trial& trial, const Stream& s, ops::Tensor key_value, ops::Tensor visible) {
  const auto qkv = trial->scratch("qkv", kRows, 768);
  const auto wide = trial->scratch("wide", kRows, 1024);
  const auto mixed = trial->scratch("mixed", kRows, 256);
  trial->record(ops::LayerNorm{.x = s.h, .gain = s.gain, .shift = s.shift, .y = s.x});
  trial->record(ops::Attention{.query = s.x,
                               .query_column = 0,
                               .key_value = key_value,
                               .key_column = 0,
                               .value_column = 256,
                               .per_draw = false,
                               .key_valid = visible,
                               .out = mixed});
  trial->record(
      ops::Linear{.x = mixed, .layer = trial.layer(256, 256, 40), .y = s.h, .residual = s.h});
  trial->record(
      ops::Linear{.x = s.h, .layer = trial.layer(768, 256, 50), .y = qkv, .residual = {}});
  trial->record(ops::Attention{.query = qkv,
                               .query_column = 0,
                               .key_value = qkv,
                               .key_column = 256,
                               .value_column = 512,
                               .per_draw = true,
                               .key_valid = {},
                               .out = mixed});
  trial->record(ops::Linear{.x = mixed,
                            .layer = trial.layer(1024, 256, 60),
                            .y = wide,
                            .activation = ops::Activation::kGelu,
                            .residual = {}});
  trial->record(
      ops::Linear{.x = wide, .layer = trial.layer(256, 1024, 70), .y = s.h, .residual = s.h});
}

/// Down by two and up again. All blocks are in use: what the rows of others hold is not compared.
void record_image(Trial& trial) {
  constexpr int kCapacity = 5;
  constexpr int kPlaces = kCapacity * 256;  // of side 16
  const auto map =
      trial.input(kCapacity, 12, flowdlo::testing::block_map(kCapacity, kCapacity, 3, 6).rows);
  const auto image = trial.input(kPlaces, 16, noise(kPlaces * 16, 7));
  const auto fine = trial.output(kPlaces, 32);
  const auto pooled = trial->scratch("pooled", kPlaces / 4, 32);
  const auto coarse = trial->scratch("coarse", kPlaces / 4, 32);
  const auto layer = [&](int taps, int in, std::uint64_t seed) {
    return trial->convolution("convolution", 32, taps, in,
                              noise(static_cast<std::size_t>(32 * taps * in), seed, 0.05F),
                              noise(32, seed + 1));
  };
  trial->record(
      ops::Convolution{.x = image, .map = map, .layer = layer(9, 16, 100), .y = fine, .side = 16});
  trial->record(ops::MaxPool{.x = fine, .map = map, .y = pooled, .side = 16});
  trial->record(ops::Convolution{
      .x = pooled, .map = map, .layer = layer(1, 32, 110), .y = coarse, .side = 8, .relu = false});
  trial->record(ops::AddUpsampled{.x = coarse, .map = map, .y = fine, .side = 16});
}

}  // namespace

void record_every_op(Trial& trial) {
  const auto cloud = trial.input(1000, 4, noise(4000, 1, 0.1F));
  const auto params = trial.input(1, 16, frame_params());
  const auto field = trial.input(32 * 24, 4, noise(32 * 24 * 4, 2));
  const auto source = trial.input(kRows, 4, noise(kRows * 4, 3));
  const auto depth = trial.input(64 * 48, 1, std::vector<float>(64 * 48, 0.3F));
  const auto visible = trial.output(256, 4);
  const auto norm = trial.output(1, 4);
  const auto state = trial.output(kRows, 4);
  const auto nodes_cam = trial.output(kRows, 4);
  const auto local = trial->scratch("local", kRows, 8);
  const Stream stream{.h = trial->scratch("h", kRows, 256),
                      .x = trial->scratch("x", kRows, 256),
                      .gain = trial->constant("gain", 1, 256, noise(256, 4)),
                      .shift = trial->constant("shift", 1, 256, noise(256, 5))};

  trial->stage("evidence");
  trial->record(ops::Copy{.from = source, .to = state});
  trial->record(ops::FarthestPoints{.cloud = cloud, .params = params, .visible = visible});
  trial->record(ops::FrameNormalization{.points = visible, .norm = norm});
  const auto key_value = record_evidence(trial, visible, norm);
  const auto head = trial.layer(4, 256, 80);
  const auto features = trial.layer(256, 8, 90);
  for (const float t : {0.0F, 0.5F}) {
    trial->stage("features");
    trial->record(ops::MaskFeatures{.state = state,
                                    .norm = norm,
                                    .params = params,
                                    .field = field,
                                    .depth = depth,
                                    .out = local});
    trial->record(
        ops::Narrow{.x = local, .layer = features, .y = stream.h, .first = {}, .second = {}});
    trial->stage("blocks");
    record_blocks(trial, stream, key_value, visible);
    trial->record(ops::FlowStep{
        .hidden = stream.h, .head = head, .prior = source, .state = state, .t = t, .dt = 0.5F});
  }
  trial->record(ops::Denormalize{.state = state, .norm = norm, .out = nodes_cam});
  trial->stage("image");
  record_image(trial);
}

}  // namespace flowdlo::vulkan::testing
