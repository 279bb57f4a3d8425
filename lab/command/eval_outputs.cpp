#include "command/eval_outputs.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <system_error>

#include "durability_choice.hpp"
#include "eval/figures.hpp"
#include "eval/method_rows.hpp"
#include "eval/results.hpp"
#include "files/staged_files.hpp"
#include "files/whole_file.hpp"
#include "report/report.hpp"

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;

std::string how(const eval::MergedRows& merged) {
  const std::string heading = eval::heading(merged.info, merged.devices);
  const std::size_t begin = heading.find("\n\n") + 2;  // without its title
  return heading.substr(begin, heading.find_last_not_of('\n') + 1 - begin);
}

}  // namespace

void add_contender_options(CLI::App& command, eval::ContenderConfig& contenders) {
  command
      .add_option("--baselines", contenders.baselines,
                  "trackdlo, trackdlo-repaired, geodesic, mbest, dloftbs, or all")
      ->delimiter(',')
      ->type_name("NAME,...");
  command
      .add_option("--models", contenders.models,
                  "Folder of NAME.fdw to compare; full, no-points, direct and residual are the "
                  "thesis' ablations")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
}

void add_results_option(CLI::App& command, fs::path& file) {
  command.add_option("--results", file, "Write results.md here as well")->type_name("FILE");
}

Result<void> save_chapter(const fs::path& out, const fs::path& results,
                          const eval::MergedRows& merged) {
  const auto figures = eval::figures(merged.trials);
  if (!figures) return figures.error();
  const std::string page = eval::results_markdown(merged.trials, how(merged));
  std::error_code failure;
  fs::create_directories(out / "figures", failure);
  if (failure) {
    return Error{ErrorCode::kIo, fmt::format("{}: cannot be made: {}; choose another folder",
                                             (out / "figures").string(), failure.message())};
  }
  files::StagedFiles staged(support::chosen_durability());
  for (const eval::Figure& figure : *figures) {
    if (auto done = staged.add(out / "figures" / (figure.name + ".png"), figure.png); !done) {
      return done;
    }
  }
  if (auto done = staged.add(out / "methods.csv", eval::method_rows_csv(merged.trials)); !done) {
    return done;
  }
  const std::string html = report::report_html(merged.trials, page, *figures);
  if (auto done = staged.add(out / "report.html", html); !done) return done;
  if (auto done = staged.add(out / "results.md", page); !done) return done;
  if (auto done = staged.commit(); !done || results.empty()) return done;
  return files::write_file(results, page, support::chosen_durability());
}

}  // namespace flowdlo::lab
