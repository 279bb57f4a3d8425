// The video that flowdlo estimate --video writes; without ffmpeg, what is said of that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "frame/temporary_folder.hpp"
#include "video_file.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
using flowdlo::test::TemporaryFolder;
using ::testing::HasSubstr;

bool has_ffmpeg() {
  return std::system("ffmpeg -version > /dev/null 2>&1 && ffprobe -version > /dev/null 2>&1") == 0;
}

std::string printed_by(const std::string& line) {
  std::string text;
  std::FILE* pipe = ::popen(line.c_str(), "r");
  for (int letter = std::fgetc(pipe); letter != EOF; letter = std::fgetc(pipe)) {
    text += static_cast<char>(letter);
  }
  ::pclose(pipe);
  return text;
}

/// "81x60,3": columns, rows, frames.
std::string size_of(const fs::path& video) {
  return printed_by(
      "ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames"
      " -of csv=p=0:s=x '" +
      video.string() + "'");
}

/// The colour in the middle of the video's frame of that index, RGB.
std::string middle_of(const fs::path& video, int frame) {
  return printed_by("ffmpeg -v error -i '" + video.string() + "' -vf \"select=eq(n\\," +
                    std::to_string(frame) + "),crop=2:2,format=rgb24\" -frames:v 1 -f rawvideo -");
}

support::Picture plain(int width, int height, const support::Color& color) {
  return {{width, height}, color};
}

std::size_t entries_of(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(VideoFile, HasEveryPictureInOneSize) {
  if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg is installed";
  const TemporaryFolder folder;
  const auto file = folder.path() / "-odd: name.mp4";
  auto video = VideoFile::open(file, 10);
  ASSERT_TRUE(video) << video.error().message;
  video->add(plain(81, 60, {0, 0, 220}));
  video->add(plain(81, 60, {0, 220, 0}));
  video->add(plain(300, 40, {220, 0, 0}));
  const auto done = video->finish();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(size_of(file), "82x60x3\n");
  for (const int frame : {0, 1, 2}) {
    const auto middle = middle_of(file, frame);
    ASSERT_GE(middle.size(), 3U);
    for (std::size_t c = 0; c < 3; ++c) {
      const bool bright = static_cast<int>(c) == frame;
      EXPECT_NEAR(static_cast<unsigned char>(middle[c]), bright ? 220 : 0, 16) << frame << c;
    }
  }
  EXPECT_EQ(entries_of(folder.path()), 1U);
}

TEST(VideoFile, ThatIsNotFinishedLeavesNothing) {
  if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg is installed";
  const TemporaryFolder folder;
  const auto file = folder.path() / "cut.mp4";
  {
    auto video = VideoFile::open(file, 10);
    ASSERT_TRUE(video);
    video->add(plain(64, 48, {1, 2, 3}));
  }
  EXPECT_EQ(entries_of(folder.path()), 0U);
}

TEST(VideoFile, WithoutPicturesReplacesNothing) {
  if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg is installed";
  const TemporaryFolder folder;
  const auto file = folder.path() / "kept.mp4";
  test::write_text(file, "mine");
  auto video = VideoFile::open(file, 10);
  ASSERT_TRUE(video);
  EXPECT_FALSE(video->finish());
  EXPECT_EQ(test::read_text(file), "mine");
}

TEST(VideoFile, ReplacesALinkAndDoesNotFollowIt) {
  if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg is installed";
  const TemporaryFolder folder;
  const auto file = folder.path() / "link.mp4";
  const auto other = folder.path() / "other";
  test::write_text(other, "theirs");
  fs::create_symlink(other, file);
  auto video = VideoFile::open(file, 10);
  ASSERT_TRUE(video);
  video->add(plain(64, 48, {1, 2, 3}));
  ASSERT_TRUE(video->finish());
  EXPECT_FALSE(fs::is_symlink(file));
  EXPECT_EQ(test::read_text(other), "theirs");
  EXPECT_EQ(entries_of(folder.path()), 2U);
}

TEST(VideoFile, NeedsAFolder) {
  const TemporaryFolder folder;
  const auto video = VideoFile::open(folder.path() / "no" / "where.mp4", 10);
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, ErrorCode::kIo);
  EXPECT_THAT(video.error().message, HasSubstr("where.mp4"));
}

/// A folder with a program named ffmpeg that does what `script` says, and no other program.
class Path {
 public:
  Path(const fs::path& folder, const std::string& script) : before_(std::getenv("PATH")) {
    fs::create_directories(folder);
    if (!script.empty()) {
      const auto program = folder / "ffmpeg";
      test::write_text(program, "#!/bin/sh\n" + script + "\n");
      fs::permissions(program, fs::perms::owner_all);
    }
    ::setenv("PATH", folder.c_str(), 1);
  }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;
  ~Path() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

TEST(VideoFile, WithoutFfmpegSaysWhatToInstall) {
  const TemporaryFolder folder;
  for (const std::string script : {"", "exit 3"}) {
    const Path path(folder.path() / ("bin" + script), script);
    const auto video = VideoFile::open(folder.path() / "a.mp4", 10);
    ASSERT_FALSE(video);
    EXPECT_EQ(video.error().code, ErrorCode::kIo);
    EXPECT_THAT(video.error().message, HasSubstr("ffmpeg"));
    EXPECT_THAT(video.error().message, HasSubstr("install"));
  }
}

TEST(VideoFile, SaysWhatAFailingFfmpegSaid) {
  const TemporaryFolder folder;
  const Path path(folder.path() / "bin",
                  "[ \"$1\" = -version ] && exit 0\necho no such encoder >&2\nexit 4");
  auto video = VideoFile::open(folder.path() / "a.mp4", 10);
  ASSERT_TRUE(video) << video.error().message;
  for (int i = 0; i < 50; ++i) video->add(plain(640, 480, {1, 2, 3}));
  const auto done = video->finish();
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("ended with 4: no such encoder"));
  EXPECT_EQ(entries_of(folder.path()), 1U);  // the program alone
}

}  // namespace
}  // namespace flowdlo::tools
