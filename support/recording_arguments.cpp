#include "recording_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "progress_bar.hpp"
#include "recording/recording.hpp"
#include "terminal.hpp"

namespace flowdlo::support {
namespace {

constexpr const char* kGroup = "Recordings (FRAME is a .bag)";
constexpr double kLongest_ms = 1e6;
constexpr double kLongest_s = 1e9;
constexpr std::size_t kBounds = 6;

recording::RecordingOptions resolved(const RecordingArguments& arguments) {
  auto options = arguments.options;
  if (arguments.hsv.size() == kBounds) {
    options.hsv.emplace();
    std::copy(arguments.hsv.begin(), arguments.hsv.end(), options.hsv->begin());
  }
  return options;
}

void add_topics(CLI::App& command, RecordingArguments& arguments) {
  auto& options = arguments.options;
  const auto topic = [&](const char* name, std::string& value, const char* what) {
    return command.add_option(name, value, what)
        ->capture_default_str()
        ->type_name("TOPIC")
        ->group(kGroup);
  };
  topic("--color-topic", options.color_topic, "Colour; with --mask-topic not needed");
  topic("--depth-topic", options.depth_topic, "Depth, aligned to the colour camera");
  topic("--camera-topic", options.camera_topic, "CameraInfo of that camera");
  auto* mask = topic("--mask-topic", options.mask_topic, "The rope's mask, mono8; or --hsv");
  command
      .add_option("--hsv", arguments.hsv,
                  "The rope's colours, low and high: hue 0-179 (low > high: through red), "
                  "saturation and value 0-255")
      ->delimiter(',')
      ->expected(static_cast<int>(kBounds))
      ->check(CLI::Range(0, 255))
      ->excludes(mask)
      ->type_name("H,S,V,H,S,V")
      ->group(kGroup);
}

void add_selection(CLI::App& command, RecordingArguments& arguments) {
  auto& options = arguments.options;
  command
      .add_option("--sync-tolerance", options.sync_tolerance_ms,
                  "Milliseconds between a depth image and its partners, at most")
      ->capture_default_str()
      ->check(CLI::Range(0.0, kLongest_ms))
      ->type_name("MS")
      ->group(kGroup);
  command.add_option("--every", options.every, "Every Nth set of images that match")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->group(kGroup);
  command.add_option("--from", options.from_s, "Seconds since the first depth image")
      ->capture_default_str()
      ->check(CLI::Range(0.0, kLongest_s))
      ->type_name("S")
      ->group(kGroup);
  command.add_option("--to", options.to_s, "Seconds since the first depth image [the end]")
      ->check(CLI::Range(0.0, kLongest_s))
      ->type_name("S")
      ->group(kGroup);
  command
      .add_flag("--rectified", options.rectified,
                "The images are rectified: P of the camera info holds, not K and D")
      ->group(kGroup);
}

}  // namespace

void add_recording_options(CLI::App& command, RecordingArguments& arguments) {
  arguments.options.color_required = false;
  add_topics(command, arguments);
  add_selection(command, arguments);
}

OpenRecording recording_opener(const RecordingArguments& arguments, bool quiet) {
  return [options = resolved(arguments),
          quiet](const std::filesystem::path& file) -> Result<std::vector<FrameEntry>> {
    std::optional<ProgressBar> bar;
    const auto progress = [&](std::size_t, std::size_t total) {
      if (!bar) bar.emplace("reading stamps", static_cast<int>(total), quiet);
      bar->advance();
    };
    const auto opened = recording::Recording::open(file, options, progress);
    bar.reset();
    if (!opened) return opened.error();
    const auto recording = *opened;
    if (!quiet) tell_error("{}\n", recording->summary());
    std::vector<FrameEntry> frames;
    for (std::size_t i = 0; i < recording->size(); ++i) {
      frames.push_back({file, recording->name(i), [recording, i] { return recording->load(i); }});
    }
    return frames;
  };
}

std::string described(const RecordingArguments& arguments) {
  const auto& options = arguments.options;
  return fmt::format(
      "color {} depth {} camera {} mask {} hsv {} tolerance {} ms every {} from {} s "
      "to {} s{}",
      options.color_topic, options.depth_topic, options.camera_topic, options.mask_topic,
      fmt::join(arguments.hsv, ","), options.sync_tolerance_ms, options.every, options.from_s,
      options.to_s, options.rectified ? " rectified" : "");
}

Result<FrameFolder> load_frame(const FrameEntry& entry) {
  return entry.read ? entry.read() : load_frame_folder(entry.folder);
}

}  // namespace flowdlo::support
