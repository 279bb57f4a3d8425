#include <cstring>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 1e-5F;  // of the largest feature, at most 3

struct Image {
  int width = 320;
  int height = 240;
};

std::vector<float> params_of(Image image) {
  ops::FrameParams params{};
  params.fx = params.fy = 0.9F * static_cast<float>(image.width);
  params.cx = 0.5F * static_cast<float>(image.width);
  params.cy = 0.5F * static_cast<float>(image.height);
  params.width = static_cast<float>(image.width);
  params.height = static_cast<float>(image.height);
  params.field_width = static_cast<float>(std::max(image.width / 2, 1));
  params.field_height = static_cast<float>(std::max(image.height / 2, 1));
  std::vector<float> values(16);
  std::memcpy(values.data(), &params, sizeof(params));
  return values;
}

/// Nodes inside and outside the image, and behind the camera.
std::vector<float> nodes(int rows) {
  std::vector<float> state = noise(static_cast<std::size_t>(rows) * 4, 7);
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); row += 9) state[4 * row + 2] = -4;
  return state;
}

std::vector<float> depths(Image image) {
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  std::vector<float> depth(count);
  for (std::size_t i = 0; i < count; ++i) {
    depth[i] = i % 7 == 0 ? 0.0F : 0.3F + 0.0001F * static_cast<float>(i % 3000);
  }
  return depth;
}

Record features(int rows, Image image, bool depth, int spare_texels = 0) {
  return [=](Trial& trial) {
    const int texels = std::max(image.width / 2, 1) * std::max(image.height / 2, 1);
    const auto size = static_cast<std::size_t>(texels) * 4;
    const auto state = trial.input(rows, 4, nodes(rows));
    const auto norm = trial.input(1, 4, {0.0F, 0.0F, 0.45F, 0.12F});
    const auto params = trial.input(1, 16, params_of(image));
    const auto field = trial.input(texels + spare_texels, 4, noise(size, 8, 20));
    const auto out = trial.output(rows, 8);
    ops::MaskFeatures op{
        .state = state, .norm = norm, .params = params, .field = field, .depth = {}, .out = out};
    if (depth) op.depth = trial.input(image.width * image.height, 1, depths(image));
    trial->record(op);
  };
}

TEST(MaskFeatures, EqualTheirTwin) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int draws : {1, 3, 64}) {
    expect_twins(features(64 * draws, {320, 240}, false), kTolerance);
  }
}

TEST(MaskFeatures, WithDepthEqualTheirTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(features(256, {320, 240}, true), kTolerance);
}

TEST(MaskFeatures, OfALargeImageEqualTheirTwinWhateverATexelBufferHolds) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(features(256, {1280, 720}, true), kTolerance);
}

TEST(MaskFeatures, OfAnImageSmallerThanTheCapacityEqualTheirTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(features(64, {31, 17}, false, /*spare_texels=*/5000), kTolerance);
  expect_twins(features(64, {1, 1}, true, /*spare_texels=*/100), kTolerance);
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
