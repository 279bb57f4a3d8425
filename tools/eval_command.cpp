#include "eval_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/error_overlay.hpp"
#include "eval/evaluator.hpp"
#include "eval/method_rows.hpp"
#include "eval/plots.hpp"
#include "eval/results.hpp"
#include "eval/tables.hpp"
#include "flowdlo/frame_folder.hpp"
#include "frame/staged_files.hpp"
#include "frame_list.hpp"
#include "model_options.hpp"
#include "progress_bar.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

struct EvalOptions {
  std::vector<fs::path> frames;
  fs::path out;
  fs::path results;
  Config config;
  eval::ContenderConfig contenders;
  int worst = 0;
  bool quiet = false;
};

ExitCode complain(const Error& error, ExitCode exit_code) {
  fmt::print(stderr, "{}\n", error.message);
  return exit_code;
}

std::vector<eval::Trial> run_all(const EvalOptions& options, const std::vector<FrameEntry>& frames,
                                 eval::Evaluator& evaluator) {
  ProgressBar progress("eval", static_cast<int>(frames.size()), options.quiet);
  std::vector<eval::Trial> trials;
  for (const FrameEntry& entry : frames) {
    trials.push_back(evaluator.run(entry.folder, entry.name));
    progress.advance();
  }
  return trials;
}

std::string how(const EvalOptions& options, const eval::Evaluator& evaluator) {
  return fmt::format(
      "{} draws of {} steps on {}; weights: {}.", options.config.draws, options.config.euler_steps,
      evaluator.device(),
      options.config.weights.empty() ? "those that ship" : options.config.weights.string());
}

Result<void> save(const EvalOptions& options, const std::string& tables, const std::string& results,
                  const std::vector<eval::Trial>& trials) {
  const fs::path& out = options.out;
  std::error_code failure;
  fs::create_directories(out, failure);
  if (failure || !fs::is_directory(out, failure)) {
    return Error{ErrorCode::kIo, fmt::format("--out {}: cannot be made: {}; choose another folder",
                                             out.string(), failure.message())};
  }
  const auto bars = eval::error_bars_png(trials);
  if (!bars) return bars.error();
  const auto curve = eval::error_curve_png(trials);
  if (!curve) return curve.error();
  frame::StagedFiles staged;
  if (auto done = staged.add(out / "tables.md", tables); !done) return done;
  if (auto done = staged.add(out / "rows.csv", eval::rows_csv(trials)); !done) return done;
  if (auto done = staged.add(out / "results.md", results); !done) return done;
  if (auto done = staged.add(out / "methods.csv", eval::method_rows_csv(trials)); !done)
    return done;
  if (!options.results.empty()) {
    if (auto done = staged.add(options.results, results); !done) return done;
  }
  if (auto done = staged.add(out / "error_bars.png", *bars); !done) return done;
  if (auto done = staged.add(out / "error_curve.png", *curve); !done) return done;
  return staged.commit();
}

/// Pictures of the frames of the largest errors, DIR/worst/<frame name>.png.
Result<void> draw_worst(const EvalOptions& options, const std::vector<FrameEntry>& frames,
                        const std::vector<eval::Trial>& trials) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (trials[i].of("estimate") != nullptr) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return trials[a].of("estimate")->either_index_m > trials[b].of("estimate")->either_index_m;
  });
  order.resize(std::min(order.size(), static_cast<std::size_t>(options.worst)));
  std::error_code failure;
  fs::create_directories(options.out / "worst", failure);
  frame::StagedFiles staged;
  for (const std::size_t i : order) {
    const auto folder = load_frame_folder(frames[i].folder);
    if (!folder) return folder.error();
    const auto picture = eval::error_overlay_png(folder->frame(), trials[i].truth, trials[i].nodes);
    if (!picture) return picture.error();
    const auto file = options.out / "worst" / (trials[i].name + ".png");
    if (auto done = staged.add(file, *picture); !done) return done;
  }
  return staged.commit();
}

ExitCode run(const EvalOptions& options) {
  const auto frames = list_frames(options.frames);
  if (!frames) return complain(frames.error(), ExitCode::kUsage);
  auto evaluator = eval::Evaluator::create(options.config, options.contenders);
  if (!evaluator) return complain(evaluator.error(), ExitCode::kUsage);
  const auto trials = run_all(options, *frames, *evaluator);
  const std::string run = how(options, *evaluator);
  const std::string tables = "# Evaluation\n\n" + run + "\n\n" + eval::tables_markdown(trials);
  const std::string results = eval::results_markdown(trials, run);
  if (const auto saved = save(options, tables, results, trials); !saved) {
    return complain(saved.error(), ExitCode::kFailed);
  }
  if (options.worst > 0) {
    if (const auto drawn = draw_worst(options, *frames, trials); !drawn) {
      return complain(drawn.error(), ExitCode::kFailed);
    }
  }
  if (!options.quiet) fmt::print("{}", tables);
  return ExitCode::kDone;
}

void add_contender_options(CLI::App& command, EvalOptions& options) {
  command
      .add_option("--baselines", options.contenders.baselines,
                  "trackdlo, trackdlo-repaired, geodesic, mbest, dloftbs, or all")
      ->delimiter(',')
      ->type_name("NAME,...");
  command
      .add_option("--models", options.contenders.models,
                  "Folder of NAME.fdw to compare; full, no-points, direct and residual are the "
                  "thesis' ablations")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  command.add_option("--results", options.results, "Write results.md here as well")
      ->type_name("FILE");
}

}  // namespace

void add_eval_command(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<EvalOptions>();
  auto* command = app.add_subcommand("eval", "Frames with truth in, tables and plots out");
  command->add_option("DATASET", options->frames, "Folders of frame folders, or frame folders")
      ->required();
  command->add_option("--out", options->out, "For tables.md, results.md, rows and plots")
      ->required()
      ->type_name("DIR");
  add_model_options(*command, options->config);
  add_contender_options(*command, *options);
  command->add_option("--worst", options->worst, "Draw the N frames of the largest errors")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
