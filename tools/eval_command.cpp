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
#include "eval/plots.hpp"
#include "eval/sweep.hpp"
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
  Config config;
  int worst = 0;
  std::vector<int> sweep_steps;
  std::vector<int> sweep_draws;
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

std::string heading(const EvalOptions& options, const eval::Evaluator& evaluator) {
  return fmt::format(
      "# Evaluation\n\n{} draws of {} steps on {}; weights: {}.\n\n", evaluator.estimator().draws(),
      evaluator.estimator().euler_steps(), evaluator.estimator().device(),
      options.config.weights.empty() ? "those that ship" : options.config.weights.string());
}

Result<void> save(const fs::path& out, const std::string& tables,
                  const std::vector<eval::Trial>& trials) {
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

/// Error against K and D in place of the tables.
ExitCode run_sweep(const EvalOptions& options, const std::vector<FrameEntry>& frames) {
  std::vector<fs::path> folders;
  for (const FrameEntry& entry : frames) folders.push_back(entry.folder);
  const auto steps = options.sweep_steps.empty() ? std::vector{1, 2, 4, 10} : options.sweep_steps;
  const auto draws = options.sweep_draws.empty() ? std::vector{1, 2, 4} : options.sweep_draws;
  const auto rounds = frames.size() * eval::settings_of(steps, draws);
  ProgressBar progress("sweep", static_cast<int>(rounds), options.quiet);
  const auto settings =
      eval::sweep(options.config, folders, steps, draws, [&progress] { progress.advance(); });
  if (!settings) return complain(settings.error(), ExitCode::kUsage);
  const std::string table = eval::sweep_markdown(*settings);
  std::error_code failure;
  fs::create_directories(options.out, failure);
  frame::StagedFiles staged;
  auto saved = staged.add(options.out / "sweep.md", table);
  if (saved) saved = staged.commit();
  if (!saved) return complain(saved.error(), ExitCode::kFailed);
  if (!options.quiet) fmt::print("{}", table);
  return ExitCode::kDone;
}

ExitCode run(const EvalOptions& options) {
  const auto frames = list_frames(options.frames);
  if (!frames) return complain(frames.error(), ExitCode::kUsage);
  if (!options.sweep_steps.empty() || !options.sweep_draws.empty()) {
    return run_sweep(options, *frames);
  }
  auto evaluator = eval::Evaluator::create(options.config);
  if (!evaluator) return complain(evaluator.error(), ExitCode::kUsage);
  const auto trials = run_all(options, *frames, *evaluator);
  const std::string tables = heading(options, *evaluator) + eval::tables_markdown(trials);
  if (const auto saved = save(options.out, tables, trials); !saved) {
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

}  // namespace

void add_eval_command(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<EvalOptions>();
  auto* command = app.add_subcommand("eval", "Frames with truth in, tables and plots out");
  command->add_option("DATASET", options->frames, "Folders of frame folders, or frame folders")
      ->required();
  command->add_option("--out", options->out, "For tables.md, rows.csv and the plots")
      ->required()
      ->type_name("DIR");
  add_model_options(*command, options->config);
  command->add_option("--worst", options->worst, "Draw the N frames of the largest errors")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  command
      ->add_option("--sweep-steps", options->sweep_steps,
                   "Error against K and D (sweep.md) in place of the tables, for these K")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->type_name("K,...");
  command->add_option("--sweep-draws", options->sweep_draws, "... for these D")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->type_name("D,...");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
