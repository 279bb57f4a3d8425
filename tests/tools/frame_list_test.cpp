#include "frame_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"

namespace flowdlo::support {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::write_frame;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<fs::path>& arguments) {
  const auto frames = list_frames(arguments);
  if (!frames) return {"error: " + frames.error().message};
  std::vector<std::string> names;
  for (const auto& entry : *frames) names.push_back(entry.name);
  return names;
}

TEST(FrameList, FramesKeepTheirOrder) {
  const TemporaryFolder parent;
  EXPECT_THAT(names_of({write_frame(parent.path(), "b"), write_frame(parent.path(), "a") / ""}),
              ElementsAre("b", "a"));
}

TEST(FrameList, DataSetStandsForItsFramesInOrder) {
  const TemporaryFolder parent;
  for (const char* name : {"c", "a", "b"}) write_frame(parent.path() / "set", name);
  fs::create_directories(parent.path() / "set" / "notes");
  EXPECT_THAT(names_of({parent.path() / "set"}), ElementsAre("a", "b", "c"));
}

TEST(FrameList, FolderThatIsNoFrameStaysInTheList) {
  const TemporaryFolder parent;
  fs::create_directories(parent.path() / "empty");
  EXPECT_THAT(names_of({parent.path() / "empty", parent.path() / "none"}),
              ElementsAre("empty", "none"));
}

TEST(FrameList, TwoFramesOfOneNameAreRefused) {
  const TemporaryFolder parent;
  const auto frames = list_frames(
      {write_frame(parent.path() / "one", "rope"), write_frame(parent.path() / "two", "rope")});
  ASSERT_FALSE(frames);
  EXPECT_EQ(frames.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(frames.error().message, HasSubstr("two frames are named \"rope\""));
}

TEST(FrameList, PathWithoutANameIsRefused) { EXPECT_FALSE(list_frames({fs::path("/")})); }

}  // namespace
}  // namespace flowdlo::support
