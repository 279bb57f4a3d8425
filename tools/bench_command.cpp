#include "bench_command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "bench_report.hpp"
#include "durability_choice.hpp"
#include "files/whole_file.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "model_options.hpp"
#include "progress_bar.hpp"
#include "resident_memory.hpp"
#include "terminal.hpp"
#include "threads/count.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct BenchOptions {
  fs::path frame;
  Config config;
  int frames = 30;
  fs::path json;
  bool quiet = false;
};

double since_ms(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Beside the executable: bin/flowdlo and share/flowdlo, built or installed.
Result<fs::path> shipped_frame() {
  std::error_code failure;
  const auto executable = fs::read_symlink("/proc/self/exe", failure);
  const auto frame =
      executable.parent_path().parent_path() / "share" / "flowdlo" / "frames" / "overhand_loop";
  if (!failure && fs::is_directory(frame, failure)) return frame;
  return Error{ErrorCode::kIo, fmt::format("bench: expected the frame that ships at {}, found "
                                           "none; name a frame folder: flowdlo bench FRAME",
                                           frame.string())};
}

double peak_resident_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1.0e6;  // Linux counts in KiB
}

Result<BenchReport> measure(const BenchOptions& options, const FrameFolder& folder) {
  const auto start = Clock::now();
  auto estimator = Estimator::create(options.config);
  if (!estimator) return estimator.error();
  BenchReport report{folder.name,
                     folder.width,
                     folder.height,
                     estimator->device(),
                     threads::count(options.config.threads),
                     estimator->draws(),
                     estimator->euler_steps(),
                     since_ms(start),
                     0,
                     {},
                     0,
                     0};
  const auto first_start = Clock::now();
  if (const auto first = estimator->estimate(folder.frame()); !first) return first.error();
  report.first_ms = since_ms(first_start);

  ProgressBar progress("bench", options.frames, options.quiet);
  for (int i = 0; i < options.frames; ++i) {
    const auto frame_start = Clock::now();
    auto estimate = estimator->estimate(folder.frame());
    const double total_ms = since_ms(frame_start);
    if (!estimate) return estimate.error();
    report.timings.push_back(std::move(estimate->timings));
    report.timings.back().total_ms = total_ms;  // as the caller sees it
    progress.advance();
  }
  report.rss_mb = resident_mb();
  report.rss_peak_mb = peak_resident_mb();
  return report;
}

ExitCode complain(const Error& error) {
  tell_error("{}\n", error.message);
  const bool usage = error.code == ErrorCode::kNoDevice || error.code == ErrorCode::kBadWeights;
  return usage ? ExitCode::kUsage : ExitCode::kFailed;
}

ExitCode run(const BenchOptions& options) {
  const auto path = options.frame.empty() ? shipped_frame() : Result<fs::path>(options.frame);
  if (!path) {
    tell_error("{}\n", path.error().message);
    return ExitCode::kUsage;
  }
  const auto folder = load_frame_folder(*path);
  if (!folder) return complain(folder.error());
  const auto report = measure(options, *folder);
  if (!report) return complain(report.error());
  if (!options.json.empty()) {
    const auto saved = files::write_file(options.json, bench_json(*report), chosen_durability());
    if (!saved) return complain(saved.error());
  }
  if (!options.quiet) tell("{}", bench_table(*report));
  return ExitCode::kDone;
}

}  // namespace

void add_bench_command(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  auto* command = app.add_subcommand("bench", "Milliseconds a frame, stage by stage");
  command->add_option("FRAME", options->frame, "A frame folder [the one that ships]");
  add_model_options(*command, options->config);
  command->add_option("--frames", options->frames, "Calls to time, after the first")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command->add_option("--json", options->json, "Write the figures to FILE")->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
