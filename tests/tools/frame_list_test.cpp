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

TEST(FrameList, FrameOfADataSetThatLacksItsCameraStaysInTheList) {
  const TemporaryFolder scratch;
  fs::create_directories(scratch.path() / "set" / "a");
  fs::create_directories(scratch.path() / "set" / "b");
  fs::create_directories(scratch.path() / "set" / "notes");
  test::write_text(scratch.path() / "set" / "a" / "camera.json", "{}");
  test::write_text(scratch.path() / "set" / "b" / "depth.png", "");
  const auto frames = list_frames({scratch.path() / "set"});
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_EQ((*frames)[1].name, "b");
}

TEST(FrameList, WhatIsNotThereIsNamed) {
  const TemporaryFolder scratch;
  const auto frames = list_frames({scratch.path(), scratch.path() / "nothing"});
  ASSERT_TRUE(frames);
  const auto there = all_there(*frames);
  ASSERT_FALSE(there);
  EXPECT_EQ(there.error().code, ErrorCode::kIo);
  EXPECT_NE(there.error().message.find("nothing"), std::string::npos);
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
