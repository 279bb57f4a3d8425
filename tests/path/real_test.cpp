// Five real frames, where they lie beside the project: a red rope between two grippers, a loop
// that crosses itself, a black bar in front.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "frame/png.hpp"
#include "path/path.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::test {
namespace {

namespace fs = std::filesystem;

frame::PngImage image_in(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(stream), {});
  const auto image = frame::decode_png(bytes, file.string());
  return image ? *image : frame::PngImage();  // the test then finds no rope
}

Canvas load(const fs::path& folder, Intrinsics& camera) {
  const frame::PngImage mask = image_in(folder / "mask.png");
  const frame::PngImage depth = image_in(folder / "depth.png");
  nlohmann::json json;
  std::ifstream(folder / "camera.json") >> json;
  camera = {json["fx"], json["fy"], json["cx"], json["cy"]};
  Canvas canvas(mask.format().width, mask.format().height);
  const auto lit = mask.values<std::uint8_t>();
  std::copy(lit.begin(), lit.end(), canvas.mask.begin<std::uint8_t>());
  const auto stored = depth.values<std::uint16_t>();
  const auto scale = json["depth_scale"].get<float>();
  std::transform(stored.begin(), stored.end(), canvas.depth_m.begin(),
                 [scale](std::uint16_t value) { return static_cast<float>(value) * scale; });
  return canvas;
}

struct Case {
  const char* name;
  Curve order;  ///< where the rope is seen, from its left gripper to its right one
};

class RealFrame : public ::testing::TestWithParam<Case> {};

TEST_P(RealFrame, IsOnePathOverAllPiecesInTheRightOrder) {
  const fs::path folder = test::source_dir() / "../shared/data/real" / GetParam().name;
  if (!fs::exists(folder / "mask.png"))
    GTEST_SKIP() << "no " << GetParam().name << " beside the project";
  Frame frame;
  Intrinsics camera;
  const Canvas canvas = load(folder, camera);
  frame = canvas.frame();
  frame.intrinsics = camera;

  const auto traced = path::trace(frame);

  ASSERT_TRUE(traced);
  auto points = traced->ranked.front().points_px;
  if (points.front().x() > points.back().x()) std::reverse(points.begin(), points.end());
  std::size_t from = 0;
  for (const cv::Point& stop : GetParam().order) {
    std::size_t at = from;
    const Vector2f want(static_cast<float>(stop.x), static_cast<float>(stop.y));
    while (at < points.size() && (points[at] - want).norm() > 9) ++at;
    ASSERT_LT(at, points.size()) << "not reached in order: " << stop;
    from = at;
  }
  std::size_t missed = 0;  // mask pixels further than a width from the path
  std::size_t lit = 0;
  for (int v = 0; v < canvas.mask.rows; v += 3) {
    for (int u = 0; u < canvas.mask.cols; u += 3) {
      if (canvas.mask.at<std::uint8_t>(v, u) <= 127) continue;
      ++lit;
      missed += distance_to(points, {u, v}) > traced->rope_width_px ? 1 : 0;
    }
  }
  EXPECT_LT(missed, lit / 50);
}

INSTANTIATE_TEST_SUITE_P(Mp2cdlo, RealFrame,
                         ::testing::Values(Case{"mp2cdlo_0091",
                                                {{487, 243},
                                                 {545, 295},
                                                 {595, 362},
                                                 {628, 450},
                                                 {618, 490},
                                                 {607, 460},
                                                 {640, 355},
                                                 {700, 240},
                                                 {765, 209}}},
                                           Case{"mp2cdlo_0156",
                                                {{547, 229},
                                                 {600, 272},
                                                 {658, 355},
                                                 {671, 420},
                                                 {640, 477},
                                                 {616, 430},
                                                 {632, 355},
                                                 {680, 262},
                                                 {766, 210}}},
                                           Case{"mp2cdlo_0190",
                                                {{554, 170},
                                                 {610, 220},
                                                 {661, 310},
                                                 {667, 375},
                                                 {615, 428},
                                                 {571, 395},
                                                 {575, 335},
                                                 {660, 238},
                                                 {738, 211}}},
                                           Case{"mp2cdlo_0285",
                                                {{471, 209},
                                                 {550, 260},
                                                 {627, 360},
                                                 {633, 412},
                                                 {590, 450},
                                                 {565, 432},
                                                 {570, 375},
                                                 {650, 265},
                                                 {743, 223}}},
                                           Case{"mp2cdlo_0590",
                                                {{490, 215},
                                                 {510, 226},
                                                 {560, 265},
                                                 {640, 350},
                                                 {645, 430},
                                                 {598, 470},
                                                 {557, 400},
                                                 {590, 315},
                                                 {650, 255},
                                                 {738, 210}}}),
                         [](const auto& which) { return std::string(which.param.name); });

}  // namespace
}  // namespace flowdlo::test
