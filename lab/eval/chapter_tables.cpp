#include "eval/chapter_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>

#include "eval/contenders.hpp"
#include "eval/interval.hpp"
#include "survey/table.hpp"

namespace flowdlo::eval {
namespace {

struct Column {
  std::string method;
  std::string title;
};

std::string italic(const std::string& text) { return "*" + text + "*"; }

// Those of `columns` that the data set has.
std::vector<Column> present(const DataSet& data_set, std::vector<Column> columns) {
  std::erase_if(columns,
                [&](const Column& column) { return !any_has(data_set.trials, column.method); });
  return columns;
}

std::vector<std::string> header_of(const std::vector<Column>& columns) {
  std::vector<std::string> header{"scenario", "n"};
  for (const Column& column : columns) header.push_back(column.title);
  return header;
}

// [low, high] of the mean index error over scenes, cm.
std::string interval_cell(const std::vector<const Trial*>& trials, const std::string& method) {
  std::vector<double> errors;
  for (const Trial* trial : trials) {
    if (const Outcome* outcome = trial->of(method)) errors.push_back(100 * outcome->index_m);
  }
  if (errors.empty()) return "-";
  const Interval interval = mean_interval(errors);
  return fmt::format("[{:.3f}, {:.3f}]", interval.low, interval.high);
}

// A table of errors by scenario; `thesis` gives the thesis' cells of a row.
template <class ThesisCells>
std::string error_table(const DataSet& data_set, const std::vector<Column>& columns,
                        const std::vector<std::string>& thesis_titles, const ThesisCells& thesis) {
  auto header = header_of(columns);
  if (data_set.thesis_groups) {
    for (const std::string& title : thesis_titles) header.push_back(italic(title));
  }
  survey::Table table(header);
  const auto groups = groups_of(data_set);
  for (const SceneGroup& group : groups) {
    std::vector<std::string> cells{group.name, std::to_string(group.trials.size())};
    for (const Column& column : columns) {
      cells.push_back(cell(mean_error(group.trials, column.method)));
    }
    if (group.thesis != nullptr) {
      for (const ErrorPair& pair : thesis(*group.thesis)) {
        cells.push_back(italic(cell(std::optional<ErrorPair>(pair))));
      }
    }
    table.add(std::move(cells));
  }
  std::vector<std::string> intervals{"all, 95 % interval of the index error", ""};
  for (const Column& column : columns) {
    intervals.push_back(interval_cell(groups.back().trials, column.method));
  }
  table.add(std::move(intervals));
  return table.text();
}

struct Tally {
  int valid = 0;
  int none = 0;
  int invalid = 0;
};

Tally tally_of(const std::vector<const Trial*>& trials, const std::string& name) {
  Tally tally;
  for (const Trial* trial : trials) {
    const Account* account = trial->account(name);
    if (account == nullptr) continue;
    ++(account->valid() ? tally.valid : account->output ? tally.invalid : tally.none);
  }
  return tally;
}

std::string counts(int valid, int none, int invalid) {
  return fmt::format("{} / {} / {}", valid, none, invalid);
}

}  // namespace

std::string coverage_table(const DataSet& data_set, const std::string& name,
                           const std::string& title) {
  const auto groups = groups_of(data_set);
  if (groups.empty() || groups.back().trials.front()->account(name) == nullptr) return {};
  const auto ours = present(data_set, {{"full", "our full model"}, {"estimate", "our estimate"}});
  std::vector<std::string> methods{name};
  std::vector<std::string> header{"scenario", "n", "valid / no output / invalid", title};
  for (const Column& column : ours) {
    methods.push_back(column.method);
    header.push_back(column.title);
  }
  const bool thesis = data_set.thesis_groups && name.starts_with("trackdlo");
  if (thesis) {
    for (const char* text : {"valid / no output / invalid", "TrackDLO-init", "thesis' model"}) {
      header.push_back(italic(text));
    }
  }
  survey::Table table(header);
  for (const SceneGroup& group : groups) {
    const Tally tally = tally_of(group.trials, name);
    const auto paired = having(group.trials, methods);
    std::vector<std::string> cells{group.name, std::to_string(group.trials.size()),
                                   counts(tally.valid, tally.none, tally.invalid)};
    for (const std::string& method : methods) cells.push_back(cell(mean_error(paired, method)));
    if (thesis && group.thesis != nullptr) {
      const ThesisRow& row = *group.thesis;
      cells.push_back(italic(counts(row.valid, row.no_output, row.invalid)));
      cells.push_back(italic(cell(row.trackdlo)));
      cells.push_back(italic(cell(row.paired)));
    }
    table.add(std::move(cells));
  }
  return table.text();
}

std::string conditioning_table(const DataSet& data_set) {
  const auto columns = present(data_set, {{"prior", "prior (thesis)"},
                                          {"no-points", "flow without P_obs"},
                                          {"full", "full model"},
                                          {"refined", "refined prior"},
                                          {"model", "evaluated model"},
                                          {"estimate", "estimate"}});
  if (groups_of(data_set).empty() || columns.empty()) return {};
  return error_table(data_set, columns, {"prior", "without P_obs", "full"},
                     [](const ThesisRow& row) {
                       return std::array{row.prior, row.without_points, row.full};
                     });
}

std::string sweep_table(const DataSet& data_set) {
  struct Line {
    const char* model;
    const char* title;
    const ThesisSweep* thesis;
  };
  const std::array<Line, 2> lines{
      {{"full", "velocity", &kThesisVelocity}, {"direct", "direct state", &kThesisDirect}}};
  survey::Table table(
      {"parameterization", "1 step", "4 steps", "10 steps", "20 steps", "10-step Frechet"});
  bool any = false;
  for (const Line& line : lines) {
    if (!any_has(data_set.trials, swept(line.model, 10))) continue;
    any = true;
    std::vector<std::string> cells{line.title};
    for (const int steps : kSweep) {
      const MeanError error = mean_error(data_set.trials, swept(line.model, steps));
      cells.push_back(error.scenes > 0 ? fmt::format("{:.3f}", error.index_cm) : "-");
    }
    cells.push_back(
        fmt::format("{:.3f}", mean_error(data_set.trials, swept(line.model, 10)).frechet_cm));
    table.add(std::move(cells));
    if (!data_set.thesis_groups) continue;
    std::vector<std::string> thesis{italic(std::string("thesis: ") + line.title)};
    for (const double cm : line.thesis->index_cm)
      thesis.push_back(italic(fmt::format("{:.3f}", cm)));
    thesis.push_back(italic(fmt::format("{:.3f}", line.thesis->frechet_cm)));
    table.add(std::move(thesis));
  }
  return any ? table.text() : std::string();
}

std::string residual_table(const DataSet& data_set) {
  const auto columns =
      present(data_set, {{"full", "mask only"}, {"residual", "mask + depth residual"}});
  if (!any_has(data_set.trials, "residual")) return {};
  return error_table(data_set, columns, {"mask only", "mask + depth residual"},
                     [](const ThesisRow& row) {
                       return std::array{row.full, row.residual};
                     });
}

std::string gate_table(const DataSet& data_set, const std::string& model) {
  const std::string method = model.empty() ? "model" : model;
  const std::string part = model.empty() ? "" : model + ".";
  const auto groups = groups_of(data_set);
  if (groups.empty() || !any_has(data_set.trials, method)) return {};
  const std::string prior = model.empty() ? "refined" : part + "prior";
  std::vector<Column> columns{{method, "prediction"},
                              {prior, "prior"},
                              {part + "hybrid", "hybrid"},
                              {part + "oracle", "oracle"}};
  for (const char* gate : {"gate-thesis", "gate-calibrated"}) {
    columns.push_back({part + gate, std::string("returned, ") + (gate + 5) + " gate"});
  }
  if (model.empty()) columns.push_back({"estimate", "estimate"});
  columns = present(data_set, columns);
  std::vector<std::string> header{"scenario", "trials", "accepted"};
  for (const Column& column : columns) header.push_back(column.title);
  const bool thesis = data_set.thesis_groups && !model.empty();
  if (thesis) {
    for (const char* text : {"accepted", "prediction", "prior", "hybrid"}) {
      header.push_back(italic(text));
    }
  }
  survey::Table table(header);
  for (const SceneGroup& group : groups) {
    int draws = 0;
    int accepted = 0;
    for (const Trial* trial : group.trials) {
      const Account* account = trial->account(method);
      if (account == nullptr || !account->valid()) continue;
      draws += account->draws;
      accepted += account->accepted;
    }
    std::vector<std::string> cells{
        group.name, std::to_string(draws),
        draws > 0 ? fmt::format("{:.1f} %", 100.0 * accepted / draws) : "-"};
    for (const Column& column : columns) {
      const MeanError error = mean_error(group.trials, column.method);
      cells.push_back(error.scenes > 0 ? fmt::format("{:.3f}", error.index_cm) : "-");
    }
    if (thesis && group.thesis != nullptr) {
      const ThesisRow& row = *group.thesis;
      cells.push_back(italic(fmt::format("{:.1f} %", row.accepted_percent)));
      for (const double cm : {row.prediction_cm, row.prior.index_cm, row.hybrid_cm}) {
        cells.push_back(italic(fmt::format("{:.3f}", cm)));
      }
    }
    table.add(std::move(cells));
  }
  return table.text();
}

std::string verdict_table(const DataSet& data_set) {
  if (!data_set.thesis_groups) return {};
  const auto groups = groups_of(data_set);
  if (groups.empty()) return {};
  survey::Table table({"scenario", "our prior", "*prior*", "our full model", "our estimate",
                       "*full model*", "estimate / *full model*: index, Frechet",
                       "estimate smaller in"});
  for (const SceneGroup& group : groups) {
    const MeanError estimate = mean_error(group.trials, "estimate");
    if (estimate.scenes == 0 || group.thesis == nullptr) continue;
    const ErrorPair& full = group.thesis->full;
    const bool index = estimate.index_cm < full.index_cm;
    const bool frechet = estimate.frechet_cm < full.frechet_cm;
    table.add({group.name, cell(mean_error(group.trials, "prior")),
               italic(cell(std::optional<ErrorPair>(group.thesis->prior))),
               cell(mean_error(group.trials, "full")), cell(estimate),
               italic(cell(std::optional<ErrorPair>(full))),
               fmt::format("{:.2f}, {:.2f}", estimate.index_cm / full.index_cm,
                           estimate.frechet_cm / full.frechet_cm),
               index && frechet ? "both"
               : index          ? "index error"
               : frechet        ? "Frechet distance"
                                : "neither"});
  }
  return table.text();
}

}  // namespace flowdlo::eval
