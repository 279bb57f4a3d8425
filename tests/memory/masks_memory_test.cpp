// What the ways to a mask do when memory runs out: an Error or the right bits.
#include <algorithm>
#include <array>
#include <string>

#include "flowdlo/flowdlo.h"
#include "flowdlo/mask.hpp"
#include "mask/table_scene.hpp"
#include "memory/sweep.hpp"
#include "support/estimate_bits.hpp"

namespace flowdlo::testing {
namespace {

std::string bits_of_mask(const Result<Mask>& mask) { return {mask->begin(), mask->end()}; }

class MasksMemory : public ::testing::Test {
 protected:
  TableScene scene_;
  const ColorBand red_{.red = 200, .green = 30, .blue = 40};
  const std::array<Pixel, 2> seeds_{Pixel{60, TableScene::axis_v(60)},
                                    Pixel{200, TableScene::axis_v(200)}};
};

TEST_F(MasksMemory, AMaskByColourSurvivesEveryAllocation) {
  sweep(
      "mask_from_color", [&] { return mask_from_color(scene_.frame(), red_); }, bits_of_mask);
}

TEST_F(MasksMemory, ThePlaneSurvivesEveryAllocation) {
  sweep(
      "fit_plane", [&] { return fit_plane(scene_.frame()); },
      [](const Result<Plane>& plane) {
        std::string bits;
        append(bits, *plane);
        return bits;
      });
}

TEST_F(MasksMemory, AMaskByHeightSurvivesEveryAllocation) {
  sweep(
      "mask_from_plane", [&] { return mask_from_plane(scene_.frame(), {}); }, bits_of_mask);
}

TEST_F(MasksMemory, AMaskFromClicksSurvivesEveryAllocation) {
  sweep(
      "mask_from_seeds", [&] { return mask_from_seeds(scene_.frame(), seeds_); }, bits_of_mask);
}

TEST_F(MasksMemory, MendingAMaskSurvivesEveryAllocation) {
  sweep(
      "clean_mask",
      [&] { return clean_mask(TableScene::kWidth, TableScene::kHeight, scene_.rope); },
      bits_of_mask);
}

TEST_F(MasksMemory, AMaskByCSurvivesEveryAllocation) {
  flowdlo_frame frame;
  ASSERT_EQ(flowdlo_frame_init(&frame, sizeof(frame)), FLOWDLO_OK);
  frame.color = {scene_.color_bgr.data(), 0, 0, FLOWDLO_PIXEL_BGR8, 0};
  frame.depth = {scene_.depth_m.data(), 0, 0, FLOWDLO_PIXEL_F32, 0};
  frame.width = TableScene::kWidth;
  frame.height = TableScene::kHeight;
  frame.fx = scene_.camera.fx;
  frame.fy = scene_.camera.fy;
  frame.cx = scene_.camera.cx;
  frame.cy = scene_.camera.cy;
  const std::array<float, 4> seeds = {seeds_[0].u, seeds_[0].v, seeds_[1].u, seeds_[1].v};
  Mask mask(scene_.rope.size());
  const auto from_seeds = [&]() -> Result<void> {
    std::copy(scene_.rope.begin(), scene_.rope.end(), mask.begin());
    const auto status = flowdlo_mask_from_seeds(&frame, seeds.data(), seeds.size() / 2, nullptr,
                                                mask.data(), mask.size());
    if (status == FLOWDLO_OK) return {};
    EXPECT_EQ(mask, scene_.rope) << "a call that failed wrote something";
    return Error{static_cast<ErrorCode>(status - 1), flowdlo_last_error()};
  };
  sweep("flowdlo_mask_from_seeds", from_seeds,
        [&](const Result<void>&) { return std::string(mask.begin(), mask.end()); });
}

}  // namespace
}  // namespace flowdlo::testing
