#include "estimate_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "choice.hpp"
#include "command_line.hpp"
#include "durability_choice.hpp"
#include "files/shown_name.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "flowdlo/tracker.hpp"
#include "frame_list.hpp"
#include "frame_output.hpp"
#include "hint_options.hpp"
#include "model_options.hpp"
#include "overlay.hpp"
#include "progress_bar.hpp"
#include "recording_arguments.hpp"
#include "rope_options.hpp"
#include "terminal.hpp"
#include "video_file.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

struct EstimateOptions {
  std::vector<fs::path> frames;
  fs::path out;
  Config config;
  support::RecordingArguments recordings;
  HintArguments hint_arguments;
  Hints hints;
  int curve_points = 0;  // 0: no curve.csv
  bool tensors = false;
  bool field_overlay = false;
  bool quiet = false;
  bool stream = false;       // each estimate is told of the one before
  fs::path video;            // empty: none
  double frames_per_s = 15;  // of the video
  RopeArguments ropes;
};

void complain(const Error& error) { support::tell_error("{}\n", error.message); }

Result<void> make_out(const fs::path& out) {
  std::error_code failure;
  fs::create_directories(out, failure);
  if (failure || !fs::is_directory(out, failure)) {
    return Error{ErrorCode::kIo, fmt::format("--out {}: cannot be made: {}; choose another folder",
                                             files::shown(out), failure.message())};
  }
  return {};
}

Provenance provenance_of(const EstimateOptions& options, const support::FrameEntry& entry,
                         const Estimator& estimator) {
  return {entry.name,
          estimator.device(),
          options.config.weights.string(),
          estimator.euler_steps(),
          estimator.draws(),
          options.config.seed,
          estimator.field_device()};
}

std::string summary(const Estimate& estimate, const support::FrameEntry& entry,
                    const fs::path& folder) {
  return fmt::format("{}: {}, confidence {:.2f}, mask agreement {:.2f}, {:.0f} ms, {}",
                     files::shown(entry.name), name_of(estimate.source), estimate.confidence,
                     estimate.mask_agreement, estimate.timings.total_ms,
                     files::shown(folder / "overlay.png"));
}

/// Of a frame on its own.
Result<TrackedRopes> untracked(Result<Ropes> ropes) {
  if (!ropes) return ropes.error();
  return TrackedRopes{.found = *std::move(ropes), .numbers = {}, .missing = {}};
}

std::string summary(const TrackedRopes& tracked, const support::FrameEntry& entry,
                    const fs::path& folder) {
  const Ropes& ropes = tracked.found;
  float least = 1;
  for (const Estimate& rope : ropes.ropes) least = std::min(least, rope.confidence);
  return fmt::format("{}: {} rope{}, {} crossing{}, least confidence {:.2f}, {:.0f} ms, {}",
                     files::shown(entry.name), ropes.ropes.size(),
                     ropes.ropes.size() == 1 ? "" : "s", ropes.crossings.size(),
                     ropes.crossings.size() == 1 ? "" : "s", least, ropes.total_ms,
                     files::shown(folder / "overlay.png"));
}

/// What one frame leaves to the next.
struct Sequence {
  Tracker tracker;  // of --stream; without it only its estimator is asked
  Hints hints;
  fs::path recording{};  // that the frame before is of; empty: a folder
  std::optional<VideoFile> video{};
};

/// A frame without an estimate has its place in the video as well.
void add_failure(Sequence& sequence, const support::FrameEntry& entry,
                 const Result<FrameFolder>& loaded, const Error& error) {
  if (!sequence.video || !loaded) return;
  const std::string words =
      fmt::format("{}: no estimate ({})", files::shown(entry.name), name_of(error.code));
  sequence.video->add(draw_failure(loaded->frame(), words));
}

/// What there is to say about one frame, or why there is no estimate on disk.
Result<std::string> run_frame(const EstimateOptions& options, const support::FrameEntry& entry,
                              Sequence& sequence) {
  Tracker& tracker = sequence.tracker;
  Estimator& estimator = *tracker.estimator();
  const fs::path folder = options.out / entry.name;
  const auto provenance = provenance_of(options, entry, estimator);
  const auto durability = support::chosen_durability();
  if (auto forgotten = forget_results(folder, durability); !forgotten) return forgotten.error();
  const auto loaded = support::load_frame(entry);
  const auto fail = [&](const Error& error) -> Error {
    add_failure(sequence, entry, loaded, error);
    const auto written = write_failure(folder, error, provenance, durability);
    if (written) return error;
    return {error.code, error.message + "\n" + written.error().message};
  };
  if (!loaded) return fail(loaded.error());
  if (options.ropes.several) {
    const auto ropes = options.stream ? tracker.estimate_ropes(loaded->frame())
                                      : untracked(estimator.estimate_ropes(loaded->frame()));
    if (!ropes) return fail(ropes.error());
    const auto written = write_ropes(folder, loaded->frame(), *ropes, provenance, durability);
    if (!written) return fail(written.error());
    if (sequence.video) {
      sequence.video->add(draw_overlay(loaded->frame(), *ropes, provenance.device));
    }
    return summary(*ropes, entry, folder);
  }
  Tensors tensors;
  const bool looks_inside = options.tensors || options.field_overlay;
  const auto ask = [&](auto& of) {
    return looks_inside ? of.estimate(loaded->frame(), sequence.hints, tensors)
                        : of.estimate(loaded->frame(), sequence.hints);
  };
  const auto estimate = options.stream ? ask(tracker) : ask(estimator);
  if (!estimate) return fail(estimate.error());
  std::vector<Point3> curve;
  if (options.curve_points > 0) {
    auto dense = estimate->curve(options.curve_points);
    if (!dense) return fail(dense.error());
    curve = *std::move(dense);
  }
  const auto written = write_estimate(folder, loaded->frame(), *estimate,
                                      {options.tensors ? &tensors : nullptr,
                                       options.field_overlay ? &tensors.strands : nullptr, curve},
                                      provenance, durability);
  if (!written) return fail(written.error());
  if (options.stream) sequence.hints.previous.reset();  // from now on the tracker's
  if (sequence.video) {
    sequence.video->add(draw_overlay(loaded->frame(), *estimate, provenance.device,
                                     options.field_overlay ? &tensors.strands : nullptr));
  }
  return summary(*estimate, entry, folder);
}

/// Another recording is another rope, or the same at another time.
void begin_frame(const EstimateOptions& options, const support::FrameEntry& entry,
                 Sequence& sequence) {
  const fs::path recording = entry.read ? entry.folder : fs::path();
  if (options.stream && recording != sequence.recording) {
    sequence.tracker.forget();
    sequence.hints.previous = options.hints.previous;
  }
  sequence.recording = recording;
}

support::ExitCode run_frames(const EstimateOptions& options,
                             const std::vector<support::FrameEntry>& frames, Sequence& sequence) {
  support::ProgressBar progress("estimate", static_cast<int>(frames.size()), options.quiet);
  auto exit_code = support::ExitCode::kDone;
  for (const auto& entry : frames) {
    begin_frame(options, entry, sequence);
    const auto outcome = run_frame(options, entry, sequence);
    progress.clear();
    if (!outcome) {
      exit_code = support::ExitCode::kFailed;
      support::tell_error("{}: no estimate ({}): {}\n", files::shown(entry.name),
                          name_of(outcome.error().code), outcome.error().message);
    } else if (!options.quiet) {
      support::tell("{}\n", *outcome);
      std::fflush(stdout);
    }
    progress.advance();
  }
  if (!sequence.video) return exit_code;
  if (const auto written = sequence.video->finish(); !written) {
    complain(written.error());
    return support::ExitCode::kFailed;
  }
  if (!options.quiet) support::tell("{}\n", files::shown(options.video));
  return exit_code;
}

support::ExitCode run(EstimateOptions& options) {
  const auto hints = hints_of(options.hint_arguments);
  if (!hints) {
    complain(hints.error());
    return support::ExitCode::kUsage;
  }
  options.hints = *hints;
  const bool in_full = options.tensors && options.config.quality == Quality::kAuto;
  if (in_full) options.config.quality = Quality::kFull;
  put_ropes(options.ropes, options.config);
  const auto frames = support::list_frames(
      options.frames, support::recording_opener(options.recordings, options.quiet));
  if (!frames) {
    complain(frames.error());
    return support::ExitCode::kUsage;
  }
  if (const auto made = make_out(options.out); !made) {
    complain(made.error());
    return support::ExitCode::kUsage;
  }
  for (const auto& entry : *frames) {
    std::error_code failure;
    if (entry.read || !fs::equivalent(entry.folder, options.out / entry.name, failure)) continue;
    complain({ErrorCode::kBadInput,
              fmt::format("--out {}: expected a folder away from the frames, got one whose {} is a "
                          "frame itself; results of an earlier run are removed there, choose "
                          "another folder",
                          files::shown(options.out), files::shown(entry.name))});
    return support::ExitCode::kUsage;
  }
  auto tracker = Tracker::create(options.config);
  if (!tracker) {
    complain(tracker.error());
    return support::ExitCode::kUsage;
  }
  const bool blind = tracker->estimator()->field_device().empty();
  if (options.config.field != FieldChoice::kOff && blind && !options.quiet) {
    support::tell_error(
        "estimate: there is no field.safetensors beside the weights: without a strand field "
        "strands "
        "that touch are told apart badly; give --field-weights, or --field off\n");
  }
  Sequence sequence{.tracker = *std::move(tracker), .hints = options.hints};
  if (!options.video.empty()) {
    auto video = VideoFile::open(options.video, options.frames_per_s);
    if (!video) {
      complain(video.error());
      return support::ExitCode::kUsage;
    }
    sequence.video.emplace(*std::move(video));
  }
  return run_frames(options, *frames, sequence);
}

CLI::Validator ends_in_mp4() {
  return {[](const std::string& file) {
            return file.ends_with(".mp4") ? std::string()
                                          : "expected a name that ends in .mp4, got " + file;
          },
          "", "mp4"};
}

}  // namespace

void add_estimate_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<EstimateOptions>();
  auto* command = support::add_command(app, "estimate", "Frames in, centerlines out");
  command
      ->add_option("FRAME", options->frames,
                   "Frame folders, folders of frame folders, or ROS 1 bags")
      ->required();
  command->add_option("--out", options->out, "Results go to DIR/<frame name>/")
      ->required()
      ->type_name("DIR");
  support::add_model_options(*command, options->config);
  auto* ropes = add_rope_options(*command, options->ropes);
  add_hint_options(*command, options->hint_arguments);
  command
      ->add_option("--curve", options->curve_points,
                   "Write curve.csv: so many points of the smooth curve through the nodes")
      ->check(CLI::Range(2, kMostCurvePoints))
      ->type_name("N");
  command->add_flag("--stream", options->stream,
                    "The frames follow each other: each estimate keeps the order of the ends, and "
                    "the way through the mask where the frame leaves it open, of the one before; "
                    "of several ropes each keeps its number");
  command
      ->add_option("--video", options->video,
                   "Write the overlays of all frames as one video as well; needs ffmpeg")
      ->check(ends_in_mp4())
      ->type_name("FILE.mp4");
  command->add_option("--fps", options->frames_per_s, "Frames a second of --video")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 240.0))
      ->needs("--video")
      ->type_name("N");
  for (const char* of_one : {"--first-end", "--end", "--ring", "--previous", "--curve"}) {
    command->get_option(of_one)->excludes(ropes);
  }
  command
      ->add_flag("--tensors", options->tensors,
                 "Write the model's tensors as .npy as well; with --quality full, if not said "
                 "otherwise")
      ->excludes(ropes);
  command
      ->add_option("--overlay", options->field_overlay,
                   "What overlay.png shows below the curve: plain, the image alone, or field, what "
                   "the strand field says of it")
      ->transform(support::choice<bool>({{"plain", false}, {"field", true}}))
      ->excludes(ropes)
      ->type_name("WHAT");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  support::add_recording_options(*command, options->recordings);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
