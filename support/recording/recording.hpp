// Recording: a ROS 1 bag as a sequence of frames.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"
#include "recording/recording_options.hpp"

namespace flowdlo::recording {

class Recording {
 public:
  /// Reads the index and the stamps, and matches them; `progress` hears of the stamps. Fails with
  /// kIo, or with kBadInput that lists every topic that is missing and those that are there.
  [[nodiscard]] static Result<std::shared_ptr<const Recording>> open(
      const std::filesystem::path& file, const RecordingOptions& options,
      const std::function<void(std::size_t done, std::size_t total)>& progress = {});

  /// Frames: one a depth image that has its partners, from-to, every Nth.
  [[nodiscard]] std::size_t size() const;
  /// "NAME_000012": the 12th matched set of NAME.bag from 0, whatever is selected.
  [[nodiscard]] std::string name(std::size_t index) const;
  /// How many were matched, how far apart they are, what became of the lens.
  [[nodiscard]] const std::string& summary() const;

  /// Any number of threads. Fails with kIo or kBadInput: the other frames do not suffer.
  [[nodiscard]] Result<FrameFolder> load(std::size_t index) const;

  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording();

 private:
  struct Impl;
  explicit Recording(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo::recording
