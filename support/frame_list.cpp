#include "frame_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "files/commit_record.hpp"
#include "files/shown_name.hpp"
#include "frame/frame_name.hpp"

namespace flowdlo::support {
namespace {

namespace fs = std::filesystem;

// Also what cannot be looked at.
bool may_be_there(const fs::path& file) {
  std::error_code failure;
  const auto type = fs::status(file, failure).type();
  return type != fs::file_type::not_found;
}

// Also where a change was cut off: then the camera stands in its record.
bool has_camera(const fs::path& folder) {
  return may_be_there(folder / "camera.json") || may_be_there(folder / files::kRecordName);
}

// A frame, or what lacks something to be one: to open it says what.
bool is_meant_as_frame(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder, ignored) &&
         (has_camera(folder) || may_be_there(folder / "depth.png"));
}

// The frames of a data set, sorted; empty when `folder` is none.
std::vector<fs::path> frames_of(const fs::path& folder) {
  std::vector<fs::path> frames;
  if (is_meant_as_frame(folder)) return frames;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (is_meant_as_frame(entry->path())) frames.push_back(entry->path());
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

// Also one that its recorder did not finish: opening it says so.
bool is_recording(const fs::path& argument) {
  std::error_code ignored;
  const std::string name = argument.filename().string();
  return (name.ends_with(".bag") || name.ends_with(".bag.active")) &&
         !fs::is_directory(argument, ignored);
}

std::string repeated_names(const std::vector<FrameEntry>& frames) {
  std::map<std::string, fs::path> first_of;
  std::string faults;
  for (const auto& entry : frames) {
    const auto [first, is_new] = first_of.emplace(entry.name, entry.folder);
    if (is_new) continue;
    if (!faults.empty()) faults += '\n';
    faults += fmt::format(
        "estimate: two frames are named \"{}\" and would share an output folder: {} and {}; run "
        "them with different --out",
        files::shown(entry.name), files::shown(first->second), files::shown(entry.folder));
  }
  return faults;
}

}  // namespace

Result<void> all_there(const std::vector<FrameEntry>& frames) {
  for (const auto& entry : frames) {
    if (entry.read || may_be_there(entry.folder)) continue;
    return Error{ErrorCode::kIo,
                 fmt::format("{}: expected a frame folder, or a folder of frames, got nothing of "
                             "that name",
                             files::shown(entry.folder))};
  }
  return {};
}

Result<std::vector<FrameEntry>> list_frames(const std::vector<fs::path>& arguments,
                                            const OpenRecording& open_recording) {
  std::vector<FrameEntry> frames;
  for (const auto& argument : arguments) {
    if (open_recording && is_recording(argument)) {
      auto recorded = open_recording(argument);
      if (!recorded) return recorded.error();
      frames.insert(frames.end(), recorded->begin(), recorded->end());
      continue;
    }
    auto folders = frames_of(argument);
    if (folders.empty()) folders.push_back(argument);
    for (const auto& folder : folders) frames.push_back({folder, frame::frame_name(folder), {}});
  }
  for (const auto& entry : frames) {
    if (entry.name.empty() || entry.name == "..") {
      return Error{ErrorCode::kBadInput, fmt::format("estimate: \"{}\" has no name; give the path "
                                                     "of a frame folder",
                                                     files::shown(entry.folder))};
    }
  }
  auto faults = repeated_names(frames);
  if (!faults.empty()) return Error{ErrorCode::kBadInput, std::move(faults)};
  return frames;
}

}  // namespace flowdlo::support
