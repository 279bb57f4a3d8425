#include "command/eval_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command/build_sum.hpp"
#include "command/eval_outputs.hpp"
#include "command_line.hpp"
#include "durability_choice.hpp"
#include "eval/contenders.hpp"
#include "eval/error_overlay.hpp"
#include "eval/evaluator.hpp"
#include "eval/job_loop.hpp"
#include "eval/merged_rows.hpp"
#include "eval/parts.hpp"
#include "eval/row_file.hpp"
#include "eval/sweep.hpp"
#include "eval/tables.hpp"
#include "files/folder.hpp"
#include "files/staged_files.hpp"
#include "flowdlo/frame_folder.hpp"
#include "flowdlo/weights.hpp"
#include "frame_list.hpp"
#include "model_options.hpp"
#include "progress_bar.hpp"
#include "recorded_frame.hpp"
#include "recording_arguments.hpp"
#include "terminal.hpp"
#include "threads/count.hpp"

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;

struct EvalOptions {
  std::vector<fs::path> frames;
  fs::path out;
  fs::path results;
  Config config;
  support::RecordingArguments recordings;
  eval::ContenderConfig contenders;
  int jobs = 1;
  std::string shard = "1/1";
  int worst = 0;
  std::vector<int> sweep_steps;
  std::vector<int> sweep_draws;
  bool parts = false;
  bool quiet = false;
};

struct MergeOptions {
  std::vector<fs::path> sources;
  fs::path out;
  fs::path results;
  bool quiet = false;
};

support::ExitCode complain(const Error& error, support::ExitCode exit_code) {
  support::tell_error("{}\n", error.message);
  return exit_code;
}

support::ExitCode complain(const Error& error) {
  return complain(
      error, error.code == ErrorCode::kIo ? support::ExitCode::kFailed : support::ExitCode::kUsage);
}

Result<void> make_out(const fs::path& out) {
  std::error_code failure;
  fs::create_directories(out, failure);
  if (!failure && fs::is_directory(out, failure)) return {};
  return Error{ErrorCode::kIo, fmt::format("--out {}: cannot be made: {}; choose another folder",
                                           out.string(), failure.message())};
}

Result<std::string> sum_of_weights(const fs::path& named) {
  auto info = inspect_weights(named);
  if (!info) return info.error();
  return info->sha256;
}

Result<eval::RunInfo> describe(const EvalOptions& options,
                               const std::vector<support::FrameEntry>& frames,
                               const eval::Shard& shard, const Estimator& estimator) {
  const auto sum = sum_of_weights(options.config.weights);
  if (!sum) return sum.error();
  eval::RunInfo info;
  info.settings = eval::settings_of(eval::in_full(options.config, estimator), *sum);
  info.settings["build"] = build_sum();
  const auto others = eval::settings_of(options.contenders);
  if (!others) return others.error();
  info.settings.insert(others->begin(), others->end());
  info.weights = options.config.weights.string();
  info.device = estimator.device();
  bool recorded = false;
  for (const support::FrameEntry& entry : frames) {
    info.frames.push_back(entry.name);
    recorded = recorded || entry.read;
  }
  if (recorded) info.settings["recordings"] = support::described(options.recordings);
  info.shard = shard;
  return info;
}

/// One a job. The cores are shared among them, unless --threads says otherwise.
Result<std::vector<eval::Evaluator>> create_evaluators(const EvalOptions& options,
                                                       std::size_t rows) {
  Config config = options.config;
  const auto wanted = static_cast<std::size_t>(threads::count(options.jobs));
  const int jobs = static_cast<int>(std::min(rows, wanted));
  if (config.threads == 0 && jobs > 1) config.threads = std::max(1, threads::cores() / jobs);
  std::vector<eval::Evaluator> evaluators;
  for (int i = 0; i < jobs; ++i) {
    auto evaluator = eval::Evaluator::create(config, options.contenders);
    if (!evaluator) return evaluator.error();
    evaluators.push_back(*std::move(evaluator));
  }
  return evaluators;
}

/// Evaluates the rows that `file` lacks.
Result<void> run_rows(const EvalOptions& options, const std::vector<support::FrameEntry>& frames,
                      std::vector<eval::Evaluator>& evaluators, eval::RowFile& file) {
  if (file.kept() > 0 && !options.quiet) {
    support::tell_error("{}: keeps {} rows of an earlier run, {} to go\n", file.path().string(),
                        file.kept(), file.lacking().size());
  }
  std::vector<eval::Worker> workers;
  for (eval::Evaluator& evaluator : evaluators) {
    workers.emplace_back([&](std::size_t row) {
      const support::FrameEntry& entry = frames[row];
      if (!entry.read) return evaluator.run(entry.folder, entry.name);
      return evaluator.run(support::keep_recorded_frame(options.out, entry), eval::SceneInfo{},
                           support::recorded_frame_folder(options.out, entry), entry.name);
    });
  }
  support::ProgressBar progress("eval", static_cast<int>(file.lacking().size()), options.quiet);
  return eval::run_jobs(file.lacking(), workers, [&](eval::Row row) {
    row.trial.name = frames[row.index].name;  // a row that threw has none
    auto written = file.append(row);
    progress.advance();
    return written;
  });
}

/// No table of an earlier run stands beside a failure of this one.
Result<void> forget_report(const fs::path& out) {
  const auto folder = files::Folder::open(out);
  if (!folder) return folder.error();
  for (const char* name :
       {"report.html", "results.md", "tables.md", "rows.csv", "timings.csv", "methods.csv"}) {
    if (auto done = folder->remove(name); !done) return done;
  }
  return {};
}

Result<void> save(const fs::path& out, const std::string& tables,
                  const std::vector<eval::Trial>& trials) {
  files::StagedFiles staged(support::chosen_durability());
  if (auto done = staged.add(out / "tables.md", tables); !done) return done;
  if (auto done = staged.add(out / "rows.csv", eval::rows_csv(trials)); !done) return done;
  if (auto done = staged.add(out / "timings.csv", eval::timings_csv(trials)); !done) return done;
  return staged.commit();
}

/// Pictures of the frames of the largest errors, DIR/worst/<frame name>.png.
Result<void> draw_worst(const EvalOptions& options, const std::vector<support::FrameEntry>& frames,
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
  files::StagedFiles staged(support::chosen_durability());
  for (const std::size_t i : order) {
    const auto folder = support::load_frame(frames[i]);
    if (!folder) return folder.error();
    const auto picture = eval::error_overlay_png(folder->frame(), trials[i].truth, trials[i].nodes);
    if (!picture) return picture.error();
    const auto file = options.out / "worst" / (trials[i].name + ".png");
    if (auto done = staged.add(file, *picture); !done) return done;
  }
  return staged.commit();
}

/// A table in place of the usual ones.
support::ExitCode save_table(const EvalOptions& options, const char* name,
                             const std::string& table) {
  if (const auto made = make_out(options.out); !made) return complain(made.error());
  files::StagedFiles staged(support::chosen_durability());
  auto saved = staged.add(options.out / name, table);
  if (saved) saved = staged.commit();
  if (!saved) return complain(saved.error(), support::ExitCode::kFailed);
  if (!options.quiet) support::tell("{}", table);
  return support::ExitCode::kDone;
}

std::vector<fs::path> folders_of(const std::vector<support::FrameEntry>& frames) {
  std::vector<fs::path> folders;
  for (const support::FrameEntry& entry : frames) folders.push_back(entry.folder);
  return folders;
}

/// What each part adds.
support::ExitCode run_parts(const EvalOptions& options,
                            const std::vector<support::FrameEntry>& frames) {
  const auto folders = folders_of(frames);
  support::ProgressBar progress("parts", static_cast<int>(folders.size() * eval::count_of_parts()),
                                options.quiet);
  const auto parts =
      eval::measure_parts(options.config, folders, [&progress] { progress.advance(); });
  if (!parts) return complain(parts.error(), support::ExitCode::kUsage);
  progress.clear();
  if (parts->scenes.empty()) {
    return complain({ErrorCode::kBadInput,
                     "eval --parts: expected frames with truth.csv that give an estimate, got "
                     "none; name a folder of such frames"},
                    support::ExitCode::kUsage);
  }
  return save_table(options, "parts.md", eval::parts_markdown(*parts));
}

/// Error against K and D.
support::ExitCode run_sweep(const EvalOptions& options,
                            const std::vector<support::FrameEntry>& frames) {
  const auto folders = folders_of(frames);
  const auto steps = options.sweep_steps.empty() ? std::vector{1, 2, 4, 10} : options.sweep_steps;
  const auto draws = options.sweep_draws.empty() ? std::vector{1, 2, 4} : options.sweep_draws;
  const auto rounds = frames.size() * eval::settings_of(steps, draws);
  support::ProgressBar progress("sweep", static_cast<int>(rounds), options.quiet);
  const auto settings =
      eval::sweep(options.config, folders, steps, draws, [&progress] { progress.advance(); });
  if (!settings) return complain(settings.error(), support::ExitCode::kUsage);
  return save_table(options, "sweep.md", eval::sweep_markdown(*settings));
}

/// Tables and plots of everything that `merged` holds: of one run or of many parts, the same bytes.
support::ExitCode report(const fs::path& out, const fs::path& results,
                         const eval::MergedRows& merged, bool quiet) {
  const std::string tables =
      eval::heading(merged.info, merged.devices) + eval::tables_markdown(merged.trials);
  if (const auto saved = save(out, tables, merged.trials); !saved) {
    return complain(saved.error(), support::ExitCode::kFailed);
  }
  if (const auto saved = save_chapter(out, results, merged); !saved) {
    return complain(saved.error(), support::ExitCode::kFailed);
  }
  if (!quiet) support::tell("{}\n{}", tables, eval::timing_sentence(merged.trials));
  return support::ExitCode::kDone;
}

support::ExitCode finish(const EvalOptions& options, const std::vector<support::FrameEntry>& frames,
                         const eval::RowFile& file, const eval::Shard& shard) {
  if (!shard.whole()) {
    if (!options.quiet) {
      support::tell("{}: every row of shard {} is there; flowdlo eval merge makes the tables\n",
                    file.path().string(), options.shard);
    }
    return support::ExitCode::kDone;
  }
  // What was measured goes through the file as well, so that nothing can be in the tables that
  // rows of a merge would not have.
  const auto merged = eval::merge_rows({file.path()});
  if (!merged) return complain(merged.error(), support::ExitCode::kFailed);
  if (options.worst > 0) {
    if (const auto drawn = draw_worst(options, frames, merged->trials); !drawn) {
      return complain(drawn.error(), support::ExitCode::kFailed);
    }
  }
  return report(options.out, options.results, *merged, options.quiet);
}

support::ExitCode run(const EvalOptions& options) {
  const auto shard = eval::parse_shard(options.shard);
  if (!shard) return complain(shard.error());
  const auto frames = support::list_frames(
      options.frames, support::recording_opener(options.recordings, options.quiet));
  if (!frames) return complain(frames.error(), support::ExitCode::kUsage);
  if (auto there = support::all_there(*frames); !there) {
    return complain(there.error(), support::ExitCode::kUsage);
  }
  if (!options.sweep_steps.empty() || !options.sweep_draws.empty()) {
    return run_sweep(options, *frames);
  }
  if (options.parts) return run_parts(options, *frames);
  auto evaluators = create_evaluators(options, frames->size());
  if (!evaluators) return complain(evaluators.error(), support::ExitCode::kUsage);
  const auto info = describe(options, *frames, *shard, evaluators->front().estimator());
  if (!info) return complain(info.error(), support::ExitCode::kUsage);
  if (const auto made = make_out(options.out); !made) return complain(made.error());
  auto file = eval::RowFile::open(options.out, *info);
  if (!file) return complain(file.error());
  if (const auto done = forget_report(options.out); !done) return complain(done.error());
  if (const auto ran = run_rows(options, *frames, *evaluators, *file); !ran) {
    return complain(ran.error());
  }
  return finish(options, *frames, *file, *shard);
}

support::ExitCode run_merge(const MergeOptions& options) {
  const auto merged = eval::merge_rows(options.sources);
  if (!merged) return complain(merged.error());
  if (const auto made = make_out(options.out); !made) return complain(made.error());
  if (const auto done = forget_report(options.out); !done) return complain(done.error());
  return report(options.out, options.results, *merged, options.quiet);
}

CLI::App* add_merge_command(CLI::App& eval_command, MergeOptions& options) {
  auto* command =
      support::add_command(eval_command, "merge", "Rows of shards in, tables and plots out");
  command->add_option("DIR", options.sources, "The --out folders of the shards, or row files")
      ->required();
  command->add_option("--out", options.out, "For tables, rows, figures and report.html")
      ->required()
      ->type_name("DIR");
  add_results_option(*command, options.results);
  command->add_flag("--quiet", options.quiet, "Print errors only");
  return command;
}

}  // namespace

void add_eval_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<EvalOptions>();
  auto* command = support::add_command(app, "eval", "Frames with truth in, tables and plots out");
  command->add_option("DATASET", options->frames,
                      "Folders of frame folders, frame folders, or ROS 1 bags");
  command->add_option("--out", options->out, "For tables, rows, figures and report.html")
      ->type_name("DIR");
  options->config.quality = Quality::kFull;  // the tables are of draws as well
  support::add_model_options(*command, options->config);
  add_contender_options(*command, options->contenders);
  add_results_option(*command, options->results);
  command->add_option("--jobs", options->jobs, "Frames at a time; the rows do not depend on it")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_option("--shard", options->shard, "Part i of n of the rows, for `eval merge`")
      ->capture_default_str()
      ->type_name("i/n");
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
  command->add_flag("--parts", options->parts,
                    "What each part of the estimator adds (parts.md) in place of the tables");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  support::add_recording_options(*command, options->recordings);
  auto merging = std::make_shared<MergeOptions>();
  const auto* merge = add_merge_command(*command, *merging);
  command->callback([options, merging, merge, &exit_code] {
    if (merge->parsed() && options->frames.empty()) {
      exit_code = run_merge(*merging);
      return;
    }
    if (merge->parsed()) throw CLI::ExcludesError("DATASET", "merge");
    // Not ->required(): `eval merge` does without them.
    if (options->frames.empty()) throw CLI::RequiredError("DATASET");
    if (options->out.empty()) throw CLI::RequiredError("--out");
    exit_code = run(*options);
  });
}

}  // namespace flowdlo::lab
