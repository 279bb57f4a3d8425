// Recording arguments: the options of every command that takes ROS 1 bags for frames.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "frame_list.hpp"
#include "recording/recording_options.hpp"

namespace flowdlo::support {

struct RecordingArguments {
  recording::RecordingOptions options;
  std::vector<int> hsv;  ///< six, or none
};

/// Adds --color-topic, --depth-topic, --camera-topic, --mask-topic, --hsv, --sync-tolerance,
/// --every,
/// --from, --to and --rectified. `arguments` must outlive the command's parsing.
void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// For list_frames(): a bag's frames; says on stderr how they were matched unless `quiet`.
[[nodiscard]] OpenRecording recording_opener(const RecordingArguments& arguments, bool quiet);

/// What frames of recordings depend on, in words.
[[nodiscard]] std::string described(const RecordingArguments& arguments);

/// Of a recording or of a folder. Fails as load_frame_folder() and Recording::load() do.
[[nodiscard]] Result<FrameFolder> load_frame(const FrameEntry& entry);

}  // namespace flowdlo::support
