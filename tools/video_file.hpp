// VideoFile: pictures as an .mp4, encoded by the ffmpeg program, which is asked for only here.
#pragma once

#include <filesystem>
#include <memory>

#include "flowdlo/result.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

class VideoFile {
 public:
  /// Fails with kIo where there is no ffmpeg that can be run, or no folder for `file`.
  [[nodiscard]] static Result<VideoFile> open(const std::filesystem::path& file,
                                              double frames_per_s);

  /// The next picture. The first one's size is the video's, by one pixel more where a
  /// side is odd; others are fitted into it. What fails is said by finish().
  void add(const support::Picture& picture);

  /// The file is there from now on, in place of one of its name. Fails with kIo, with what ffmpeg
  /// said, and where no picture came: then a file of that name is left as it was. Once.
  [[nodiscard]] Result<void> finish();

  VideoFile(VideoFile&&) noexcept;
  VideoFile& operator=(VideoFile&&) = delete;
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;
  ~VideoFile();  ///< without finish() nothing is left

 private:
  struct Encoder;
  explicit VideoFile(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace flowdlo::tools
