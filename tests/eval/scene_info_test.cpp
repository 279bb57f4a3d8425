#include "eval/scene_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"

namespace flowdlo::eval {
namespace {

using flowdlo::test::TemporaryFolder;
using testing::HasSubstr;

Result<SceneInfo> read(const TemporaryFolder& folder, const char* text) {
  flowdlo::test::write_text(folder.path() / "meta.json", text);
  return read_scene_info(folder.path());
}

TEST(SceneInfo, FrameWithoutMetaIsUnknown) {
  const TemporaryFolder folder;
  const auto info = read_scene_info(folder.path());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->scenario, "unknown");
  EXPECT_FALSE(info->easy());
  EXPECT_FALSE(info->hard());
}

TEST(SceneInfo, PlainSceneIsEasy) {
  const TemporaryFolder folder;
  const auto info = read(folder, R"({"scenario": "C-shape", "material": "red", "crossings": 0,
                                     "defects": {"gap": false, "mask_ragged": true}})");
  ASSERT_TRUE(info);
  EXPECT_EQ(info->scenario, "C-shape");
  EXPECT_EQ(info->material, "red");
  EXPECT_TRUE(info->easy());
  EXPECT_FALSE(info->hard());
}

TEST(SceneInfo, GapTouchCoilAndHolesAreHard) {
  const TemporaryFolder folder;
  for (const char* defect : {"gap", "touch", "coil", "depth_holes"}) {
    const auto text = std::string("{\"defects\": {\"") + defect + "\": true}}";
    const auto info = read(folder, text.c_str());
    ASSERT_TRUE(info);
    EXPECT_TRUE(info->hard()) << defect;
    EXPECT_FALSE(info->easy()) << defect;
  }
}

TEST(SceneInfo, CrossingIsNeitherEasyNorHard) {
  const TemporaryFolder folder;
  const auto info = read(folder, R"({"crossings": 1, "defects": {"gap": false}})");
  ASSERT_TRUE(info);
  EXPECT_FALSE(info->easy());
  EXPECT_FALSE(info->hard());
}

TEST(SceneInfo, BrokenFileIsNamed) {
  const TemporaryFolder folder;
  const auto info = read(folder, "{\"scenario\": ");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(info.error().message, HasSubstr("meta.json"));
}

TEST(SceneInfo, WrongTypeNamesItsField) {
  const TemporaryFolder folder;
  for (const char* text : {R"({"scenario": 3})", R"({"crossings": "two"})",
                           R"({"defects": {"gap": 1}})", R"({"defects": 1})"}) {
    const auto info = read(folder, text);
    ASSERT_FALSE(info) << text;
    EXPECT_THAT(info.error().message, HasSubstr("expected")) << text;
  }
}

}  // namespace
}  // namespace flowdlo::eval
