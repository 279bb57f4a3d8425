// The picture of a frame's error: what its colours mean stands below it, whole.
#include "eval/error_overlay.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "mat/mat_png.hpp"

namespace flowdlo::eval {
namespace {

constexpr int kLegend = 32;

/// A rope from top to bottom of a frame, and an estimate one centimetre beside it.
struct Case {
  int width;
  int height;

  [[nodiscard]] cv::Mat picture() const {
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const std::vector<float> depth_m(pixels, 0.5F);
    const std::vector<std::uint8_t> mask(pixels, 0);
    const Frame frame{
        width,   height, {100, 100, static_cast<float>(width) / 2, static_cast<float>(height) / 2},
        depth_m, mask,   {}};
    Centerline truth;
    Centerline nodes;
    std::array<std::uint8_t, kNodes> support{};
    for (std::size_t i = 0; i < kNodes; ++i) {
      const float y = 0.004F * static_cast<float>(height) * (static_cast<float>(i) / 63 - 0.5F);
      truth[i] = {0, y, 0.5F};
      nodes[i] = {0.01F, y, 0.5F};
      support[i] = i < 32 ? 1 : 0;
    }
    const auto png = error_overlay_png(frame, truth, nodes, support);
    return png ? *mat::decode_png(*png, "picture") : cv::Mat();
  }
};

class Overlay : public ::testing::TestWithParam<Case> {};

TEST_P(Overlay, HasAWholeLegend) {
  const cv::Mat picture = GetParam().picture();
  ASSERT_FALSE(picture.empty());
  const cv::Mat legend = picture.rowRange(picture.rows - kLegend, picture.rows);
  const cv::Vec3b background(25, 25, 25);
  int written = 0;
  int last = 0;
  for (int v = 0; v < legend.rows; ++v) {
    for (int u = 0; u < legend.cols; ++u) {
      if (legend.at<cv::Vec3b>(v, u) == background) continue;
      ++written;
      last = std::max(last, u);
    }
  }
  EXPECT_GT(written, 2000);
  EXPECT_GT(last, 800);
  EXPECT_LT(last, legend.cols - 5);  // nothing is cut
}

INSTANTIATE_TEST_SUITE_P(Shapes, Overlay,
                         ::testing::Values(Case{640, 480}, Case{120, 480}, Case{480, 60}));

}  // namespace
}  // namespace flowdlo::eval
