#include "command/synth_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "choice.hpp"
#include "command/synth_folder.hpp"
#include "command_line.hpp"
#include "pictures/contact_sheet.hpp"
#include "progress_bar.hpp"
#include "survey/in_parallel.hpp"
#include "synth/synthetic_frame.hpp"
#include "terminal.hpp"
#include "whole_number.hpp"

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kDefaultCount = 100;  // of splits that have no end
constexpr std::uint64_t kMostOnASheet = 60;

struct SynthOptions {
  fs::path out;
  synth::Split split = synth::Split::kWide;
  synth::Part part = synth::Part::kTraining;
  std::uint64_t count = 0;
  std::uint64_t first = 0;
  std::uint64_t seed = 0;
  int frames_per_scene = 1;
  bool matched = false;
  bool cords = false;
  std::string scenario;
  fs::path sheet;
  int threads = 0;
  bool quiet = false;
};

struct Job {
  std::uint64_t index = 0;
  int frame = 0;
};

Error usage(std::string message) { return {ErrorCode::kBadInput, std::move(message)}; }

std::string list_of(std::span<const std::string_view> names) {
  std::string text;
  for (const auto name : names) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text;
}

Result<void> check(const SynthOptions& options) {
  if (options.out.empty() && options.sheet.empty()) {
    return usage("synth: expected OUT, a folder for the frames, or --contact-sheet FILE");
  }
  if (options.split == synth::Split::kDrawn && (options.matched || options.cords)) {
    return usage(
        fmt::format("synth: {}: expected a rendered split, got drawn; drawn scenes have "
                    "plain tubes and a plain depth",
                    options.matched ? "--matched" : "--cords"));
  }
  const auto names = synth::scenarios(options.split);
  const bool known = options.scenario.empty() ||
                     std::find(names.begin(), names.end(), options.scenario) != names.end();
  if (!known) {
    return usage(fmt::format("synth: --scenario: expected one of {}, got \"{}\"", list_of(names),
                             options.scenario));
  }
  return {};
}

// The scenes asked for: `count` from `first` on, of one scenario where one is named.
Result<std::vector<Job>> jobs_of(const SynthOptions& options) {
  const std::uint64_t end = synth::scene_count(options.split, options.part);
  const std::uint64_t wanted = options.count > 0 ? options.count : end > 0 ? end : kDefaultCount;
  std::vector<Job> jobs;
  std::uint64_t scenes = 0;
  for (std::uint64_t index = options.first; scenes < wanted && (end == 0 || index < end); ++index) {
    const auto scenario = synth::scenario_of(options.split, options.part, options.seed, index);
    if (!scenario) return scenario.error();
    if (!options.scenario.empty() && *scenario != options.scenario) continue;
    ++scenes;
    for (int frame = 0; frame < options.frames_per_scene; ++frame) jobs.push_back({index, frame});
  }
  if (options.count > 0 && scenes < wanted) {
    return usage(
        fmt::format("synth: --count: expected at most {}, got {}; the {} split's {} part "
                    "has no more such scenes",
                    scenes, wanted, synth::name_of(options.split), synth::name_of(options.part)));
  }
  return jobs;
}

/// What comes of a run, beside the frames in its folder.
struct Made {
  std::vector<synth::SyntheticFrame> sheet;
  std::atomic<int> kept = 0;  ///< frames that were there already
};

Result<void> make(const SynthOptions& options, const Job& job, const SynthFolder* folder,
                  synth::SyntheticFrame* shown, std::atomic<int>& kept) {
  const synth::Render render{
      .frame = job.frame, .matched = options.matched, .cords = options.cords};
  const auto known = synth::identity(options.split, options.part, options.seed, job.index, render);
  if (!known) return known.error();
  const auto there = folder != nullptr ? folder->holds(*known) : Result<bool>(true);
  if (!there) return there.error();
  kept += folder != nullptr && *there ? 1 : 0;
  if (*there && shown == nullptr) return {};
  auto frame = synth::make_frame(options.split, options.part, options.seed, job.index, render);
  if (!frame) return frame.error();
  if (!*there) {
    if (auto saved = folder->save(*frame); !saved) return saved;
  }
  if (shown != nullptr) *shown = *std::move(frame);
  return {};
}

/// Runs the jobs on several threads; the first fault ends all of them.
Result<void> make_all(const SynthOptions& options, const std::vector<Job>& jobs,
                      const SynthFolder* folder, Made& made) {
  support::ProgressBar progress("synth", static_cast<int>(jobs.size()), options.quiet);
  made.sheet.resize(options.sheet.empty() ? 0 : std::min<std::size_t>(jobs.size(), kMostOnASheet));
  std::atomic<bool> failed = false;
  const auto work = [&](survey::Nothing, std::uint64_t k) -> Result<survey::Nothing> {
    if (failed) return survey::Nothing();
    const auto done =
        make(options, jobs[k], folder, k < made.sheet.size() ? &made.sheet[k] : nullptr, made.kept);
    if (done) return survey::Nothing();
    failed = true;
    return done.error();
  };
  for (const auto& done : survey::in_parallel<survey::Nothing>(
           {0, jobs.size()}, options.threads, survey::no_tool, work, [&] { progress.advance(); })) {
    if (!done) return done.error();
  }
  return {};
}

Result<std::string> run_jobs(const SynthOptions& options) {
  if (auto good = check(options); !good) return good.error();
  const auto jobs = jobs_of(options);
  if (!jobs) return jobs.error();
  std::optional<SynthFolder> folder;
  if (!options.out.empty()) {
    auto opened = SynthFolder::open(options.out);
    if (!opened) return opened.error();
    folder.emplace(std::move(*opened));
  }
  Made made;
  if (auto done = make_all(options, *jobs, folder ? &*folder : nullptr, made); !done) {
    return done.error();
  }
  std::string said;
  if (folder) {
    said = fmt::format("{}: {} frames of the {} split's {} part", options.out.string(),
                       jobs->size(), synth::name_of(options.split), synth::name_of(options.part));
    if (made.kept > 0) said += fmt::format(", {} of them were there already", made.kept.load());
    said += '\n';
  }
  if (!options.sheet.empty()) {
    if (auto saved = pictures::save_contact_sheet(options.sheet, made.sheet); !saved)
      return saved.error();
    said += fmt::format("{}: {} frames\n", options.sheet.string(), made.sheet.size());
  }
  return said;
}

support::ExitCode run(const SynthOptions& options) {
  const auto said = run_jobs(options);
  if (!said) {
    support::tell_error("{}\n", said.error().message);
    return said.error().code == ErrorCode::kBadInput ? support::ExitCode::kUsage
                                                     : support::ExitCode::kFailed;
  }
  if (!options.quiet) support::tell("{}", *said);
  return support::ExitCode::kDone;
}

}  // namespace

void add_synth_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<SynthOptions>();
  auto* command = support::add_command(app, "synth", "Synthetic frames with truth");
  command->add_option("OUT", options->out, "Frame folders go to OUT/<index>_<scenario>/");
  command
      ->add_option("--split", options->split,
                   "thesis (nine groups on a table, clean depth), wide (sensors, occluders, "
                   "hanging ropes), several (the same with two to nine ropes), tangled (two to six "
                   "that are looped, coiled and thrown on each other) or drawn (plain tubes of "
                   "eleven kinds) [wide]")
      ->transform(support::choice<synth::Split>({{"thesis", synth::Split::kThesis},
                                                 {"wide", synth::Split::kWide},
                                                 {"several", synth::Split::kSeveral},
                                                 {"tangled", synth::Split::kTangled},
                                                 {"drawn", synth::Split::kDrawn}}))
      ->type_name("NAME");
  command
      ->add_option("--part", options->part,
                   "training or validation; they share no scene [training]")
      ->transform(support::choice<synth::Part>(
          {{"training", synth::Part::kTraining}, {"validation", synth::Part::kValidation}}))
      ->type_name("NAME");
  command->add_option("--count", options->count, "Scenes [thesis: all, others: 100]")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--first", options->first, "Index of the first scene")
      ->capture_default_str()
      ->check(support::whole_number());
  command->add_option("--seed", options->seed, "0: the scenes of the tables")
      ->capture_default_str()
      ->check(support::whole_number());
  command
      ->add_option("--frames-per-scene", options->frames_per_scene,
                   "Of one static scene; they differ in noise and light")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command->add_flag("--matched", options->matched,
                    "Depth of stereo cameras by matching two infrared pictures, not by a model of "
                    "their noise; takes a few seconds a scene");
  command->add_flag("--cords", options->cords,
                    "Ropes laid of strands, speckled, striped or banded, in any colours, not tubes "
                    "in five colours; rendered splits");
  command->add_option("--scenario", options->scenario, "Scenes of one group only")
      ->type_name("NAME");
  command
      ->add_option("--contact-sheet", options->sheet,
                   "The first 60 frames on one PNG; OUT may be left away")
      ->type_name("FILE");
  command->add_option("--threads", options->threads, "0: one a core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::lab
