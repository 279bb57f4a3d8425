// The C interface to masks: the bytes of the C++ one, and a clear error whatever comes in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "flowdlo/flowdlo.h"
#include "flowdlo/mask.hpp"
#include "mask/table_scene.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::TableScene;

class CMasks : public ::testing::Test {
 protected:
  CMasks() {
    EXPECT_EQ(flowdlo_frame_init(&frame, sizeof(frame)), FLOWDLO_OK);
    EXPECT_EQ(flowdlo_color_band_init(&band, sizeof(band)), FLOWDLO_OK);
    EXPECT_EQ(flowdlo_height_band_init(&height, sizeof(height)), FLOWDLO_OK);
    EXPECT_EQ(flowdlo_seed_growth_init(&growth, sizeof(growth)), FLOWDLO_OK);
    band.red = 200;
    band.green = 30;
    band.blue = 40;
    frame.width = TableScene::kWidth;
    frame.height = TableScene::kHeight;
    frame.fx = scene.camera.fx;
    frame.fy = scene.camera.fy;
    frame.cx = scene.camera.cx;
    frame.cy = scene.camera.cy;
    frame.depth = {scene.depth_m.data(), 0, 0, FLOWDLO_PIXEL_F32, 0};
    frame.color = {scene.color_bgr.data(), 0, 0, FLOWDLO_PIXEL_BGR8, 0};
  }

  TableScene scene;
  flowdlo_frame frame;
  flowdlo_color_band band;
  flowdlo_height_band height;
  flowdlo_seed_growth growth;
  Mask mask = Mask(std::size_t{TableScene::kWidth} * TableScene::kHeight, 7);
  std::array<float, 2> seed{100, TableScene::axis_v(100)};
};

TEST_F(CMasks, AreThoseOfCpp) {
  ASSERT_EQ(flowdlo_mask_from_color(&frame, &band, mask.data(), mask.size()), FLOWDLO_OK);
  EXPECT_EQ(mask, *mask_from_color(scene.frame(), {.red = 200, .green = 30, .blue = 40}));
  ASSERT_EQ(flowdlo_mask_from_plane(&frame, &height, mask.data(), mask.size()), FLOWDLO_OK);
  EXPECT_EQ(mask, *mask_from_plane(scene.frame(), {}));
  const std::vector<Pixel> seeds{{seed[0], seed[1]}};
  ASSERT_EQ(flowdlo_mask_from_seeds(&frame, seed.data(), 1, &growth, mask.data(), mask.size()),
            FLOWDLO_OK);
  EXPECT_EQ(mask, *mask_from_seeds(scene.frame(), seeds));
}

TEST_F(CMasks, TakeNullForTheDefaults) {
  const Mask before = *mask_from_plane(scene.frame(), {});
  ASSERT_EQ(flowdlo_mask_from_plane(&frame, nullptr, mask.data(), mask.size()), FLOWDLO_OK);
  EXPECT_EQ(mask, before);
  ASSERT_EQ(flowdlo_mask_from_seeds(&frame, seed.data(), 1, nullptr, mask.data(), mask.size()),
            FLOWDLO_OK);
}

TEST_F(CMasks, ReadNoImageThatTheyDoNotName) {
  frame.mask = {&frame, -3, 0, 99, 1};  // nonsense
  frame.depth = {&frame, -3, 0, 99, 1};
  EXPECT_EQ(flowdlo_mask_from_color(&frame, &band, mask.data(), mask.size()), FLOWDLO_OK);
  frame.depth = {scene.depth_m.data(), 0, 0, FLOWDLO_PIXEL_F32, 0};
  frame.color = {};
  EXPECT_EQ(flowdlo_mask_from_plane(&frame, nullptr, mask.data(), mask.size()), FLOWDLO_OK);
}

TEST_F(CMasks, OfARegionAreItsPart) {
  frame.roi_u = 40;
  frame.roi_v = 21;
  frame.roi_width = 250;
  frame.roi_height = 200;
  const Mask whole = *mask_from_seeds(scene.frame(), std::vector<Pixel>{{seed[0], seed[1]}});
  std::vector<std::uint8_t> part(250 * 200);
  frame.depth = {};
  ASSERT_EQ(flowdlo_mask_from_seeds(&frame, seed.data(), 1, nullptr, part.data(), part.size()),
            FLOWDLO_OK)
      << flowdlo_last_error();
  int differ = 0;
  for (int v = 1; v < 199; ++v) {
    for (int u = 1; u < 249; ++u) {
      const auto inner = static_cast<std::size_t>(v) * 250 + static_cast<std::size_t>(u);
      differ += part[inner] != whole[TableScene::at(u + 40, v + 21)] ? 1 : 0;
    }
  }
  EXPECT_EQ(differ, 0);
}

TEST_F(CMasks, SayWhatIsWrongAndWriteNothing) {
  const auto refused = [&](flowdlo_status status, const char* why) {
    EXPECT_EQ(status, FLOWDLO_BAD_INPUT) << why;
    EXPECT_THAT(flowdlo_last_error(), HasSubstr(why));
    EXPECT_EQ(mask, Mask(mask.size(), 7));
  };
  refused(flowdlo_mask_from_color(&frame, nullptr, mask.data(), mask.size()), "flowdlo_color_band");
  refused(flowdlo_mask_from_color(nullptr, &band, mask.data(), mask.size()), "flowdlo_frame");
  refused(flowdlo_mask_from_color(&frame, &band, nullptr, mask.size()), "got NULL");
  refused(flowdlo_mask_from_color(&frame, &band, mask.data(), 5), "mask_bytes: expected 76800");
  refused(flowdlo_mask_from_seeds(&frame, nullptr, 1, nullptr, mask.data(), mask.size()), "seeds");
  refused(
      flowdlo_mask_from_seeds(&frame, seed.data(), 1000000000, nullptr, mask.data(), mask.size()),
      "count");
  refused(flowdlo_mask_from_seeds(&frame, seed.data(), 0, nullptr, mask.data(), mask.size()),
          "1 to 256 seeds");
  height.reserved = 1;
  refused(flowdlo_mask_from_plane(&frame, &height, mask.data(), mask.size()), "reserved");
  band.tolerance = -1;
  refused(flowdlo_mask_from_color(&frame, &band, mask.data(), mask.size()), "tolerance");
  frame.color = {};
  refused(flowdlo_mask_from_color(&frame, &band, mask.data(), mask.size()), "flowdlo_frame.color");
  flowdlo_color_band unfilled{};
  refused(flowdlo_mask_from_color(&frame, &unfilled, mask.data(), mask.size()), "struct_size");
}

}  // namespace
}  // namespace flowdlo
