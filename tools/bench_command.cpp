#include "bench_command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "bench_report.hpp"
#include "command_line.hpp"
#include "durability_choice.hpp"
#include "files/own_file.hpp"
#include "files/shown_name.hpp"
#include "files/whole_file.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "frame_list.hpp"
#include "model_options.hpp"
#include "progress_bar.hpp"
#include "resident_memory.hpp"
#include "terminal.hpp"
#include "threads/count.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kCalls = 30;  // of one frame

struct BenchOptions {
  fs::path frame;
  Config config;
  std::optional<int> frames;
  fs::path json;
  bool quiet = false;
};

double since_ms(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Beside the executable: bin/flowdlo and share/flowdlo, built or installed.
Result<fs::path> shipped_frame() {
  std::error_code failure;
  const auto frame = files::running_program().parent_path().parent_path() / "share" / "flowdlo" /
                     "frames" / "overhand_loop";
  if (fs::is_directory(frame, failure)) return frame;
  return Error{ErrorCode::kIo, fmt::format("bench: expected the frame that ships at {}, found "
                                           "none; name a frame folder: flowdlo bench FRAME",
                                           frame.string())};
}

double peak_resident_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1.0e6;  // Linux counts in KiB
}

// One after the other, again from the first after the last: of a set only the frame in turn is in
// memory.
class Frames {
 public:
  explicit Frames(std::vector<support::FrameEntry> entries) : entries_(std::move(entries)) {}

  [[nodiscard]] int count() const { return static_cast<int>(entries_.size()); }

  [[nodiscard]] Result<const FrameFolder*> at(int call) {
    const auto turn = static_cast<std::size_t>(call) % entries_.size();
    if (!held_ || held_turn_ != turn) {
      auto read = load_frame_folder(entries_[turn].folder);
      if (!read) return read.error();
      held_ = *std::move(read);
      held_turn_ = turn;
    }
    return &*held_;
  }

 private:
  std::vector<support::FrameEntry> entries_;
  std::optional<FrameFolder> held_;
  std::size_t held_turn_ = 0;
};

// A set goes on after a frame without an estimate, which is what one of its frames may come to.
Result<BenchReport> measure(const BenchOptions& options, Frames& frames) {
  const auto start = Clock::now();
  auto estimator = Estimator::create(options.config);
  if (!estimator) return estimator.error();
  BenchReport report;
  report.device = estimator->device();
  report.field_device = estimator->field_device();
  report.threads = threads::count(options.config.threads);
  report.draws = estimator->draws();
  report.steps = estimator->euler_steps();
  report.create_ms = since_ms(start);
  const bool one = frames.count() == 1;
  const int calls = options.frames.value_or(one ? kCalls : frames.count());

  support::ProgressBar progress("bench", calls, options.quiet);
  for (int call = -1; call < calls; ++call) {
    const auto folder = frames.at(std::max(0, call));
    if (!folder) return folder.error();
    const auto begin = Clock::now();
    auto estimate = estimator->estimate((*folder)->frame());
    const double total_ms = since_ms(begin);
    if (!estimate && one) return estimate.error();
    if (call < 0) {
      report.first_ms = total_ms;
      report.frame = (*folder)->name;
      report.width = (*folder)->width;
      report.height = (*folder)->height;
      continue;
    }
    progress.advance();
    if (!estimate) {
      ++report.without_estimate;
      continue;
    }
    report.timings.push_back(std::move(estimate->timings));
    report.timings.back().total_ms = total_ms;  // as the caller sees it
  }
  if (!one) {
    report.frame = fmt::format("{} ({} frames)", files::shown(options.frame.filename().string()),
                               frames.count());
  }
  report.rss_mb = support::resident_mb();
  report.rss_peak_mb = peak_resident_mb();
  return report;
}

support::ExitCode complain(const Error& error) {
  support::tell_error("{}\n", error.message);
  const bool usage = error.code == ErrorCode::kNoDevice || error.code == ErrorCode::kBadWeights;
  return usage ? support::ExitCode::kUsage : support::ExitCode::kFailed;
}

support::ExitCode run(const BenchOptions& options) {
  const auto path = options.frame.empty() ? shipped_frame() : Result<fs::path>(options.frame);
  if (!path) {
    support::tell_error("{}\n", path.error().message);
    return support::ExitCode::kUsage;
  }
  auto entries = support::list_frames({*path});
  if (!entries) return complain(entries.error());
  Frames frames(*std::move(entries));
  if (const auto first = frames.at(0); !first) return complain(first.error());
  const auto report = measure(options, frames);
  if (!report) return complain(report.error());
  if (!options.json.empty()) {
    const auto saved =
        files::write_file(options.json, bench_json(*report), support::chosen_durability());
    if (!saved) return complain(saved.error());
  }
  if (!options.quiet) support::tell("{}", bench_table(*report));
  return support::ExitCode::kDone;
}

}  // namespace

void add_bench_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  auto* command = support::add_command(app, "bench", "Milliseconds a frame, stage by stage");
  command->add_option("FRAME", options->frame,
                      "A frame folder [the one that ships], or a folder of them");
  options->config.quality = Quality::kFull;  // what a device takes is to be measured
  support::add_model_options(*command, options->config);
  command
      ->add_option("--frames", options->frames,
                   "Calls to time, after the first; a set's frames take turns [30, of a set one a "
                   "frame]")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--json", options->json, "Write the figures to FILE")->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
