// FrameList: the frames that a command line names, each with the name of its output folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::support {

struct FrameEntry {
  std::filesystem::path folder;                 ///< or the recording that holds the frame
  std::string name;                             ///< unique in its list
  std::function<Result<FrameFolder>()> read{};  ///< of a recording's frame; empty: a folder
};

/// The frames of a recording.
using OpenRecording = std::function<Result<std::vector<FrameEntry>>(const std::filesystem::path&)>;

/// One entry for each of `arguments`; a data set (a folder without camera.json and depth.png whose
/// folders have one of these) stands for its frames in the order of their names, and a file
/// NAME.bag for those that `open_recording` finds in it. A folder that is no frame stays in the
/// list: its estimate says what is wrong. Fails with kBadInput where two frames share a name, and
/// as `open_recording` does.
[[nodiscard]] Result<std::vector<FrameEntry>> list_frames(
    const std::vector<std::filesystem::path>& arguments, const OpenRecording& open_recording = {});

/// Fails with kIo, naming the first one of which there is nothing.
[[nodiscard]] Result<void> all_there(const std::vector<FrameEntry>& frames);

}  // namespace flowdlo::support
