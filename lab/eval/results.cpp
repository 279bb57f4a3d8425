#include "eval/results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "baselines/baseline.hpp"
#include "eval/chapter_tables.hpp"
#include "eval/coverage_tables.hpp"

namespace flowdlo::eval {
namespace {

void add(const std::string& title, const std::string& table, std::string& out,
         const std::string& text = {}) {
  if (table.empty()) return;
  out += "### " + title + "\n\n";
  if (!text.empty()) out += text + "\n\n";
  out += table;
}

void add_synthetic(const DataSet& set, std::string& out) {
  const std::string where = " (" + set.name + ")";
  const std::string pair = "Index error (Eq. 4.1) / discrete Frechet distance (Eq. 4.2), cm.";
  for (const baselines::Baseline& baseline : baselines::all_baselines()) {
    const bool first = std::string(baseline.name) == "trackdlo";
    add(fmt::format("{}: {}{}", first ? "Table 4.2" : "As Table 4.2", baseline.title, where),
        coverage_table(set, baseline.name, baseline.title), out,
        pair +
            " Errors over the scenes on which every compared method is valid; the model's are "
            "the mean over its draws.");
  }
  add("Table 4.4: conditioning" + where, conditioning_table(set), out, pair);
  add("Table 4.5: parameterization and steps" + where, sweep_table(set), out,
      "Index error, cm, and the Frechet distance at ten steps.");
  add("Table 4.6: local depth residual" + where, residual_table(set), out, pair);
  add("Table 4.7: gate on the full model of the thesis' kind" + where, gate_table(set, "full"), out,
      "Index error, cm. Hybrid: a rejected draw is replaced by the prior. Oracle: the best of "
      "draws and prior.");
  add("Table 4.7: gate on the evaluated model" + where, gate_table(set, ""), out,
      "Index error, cm.");
  add("Calibration" + where, calibration_table(set), out);
  add("Where ours is below the thesis' figure" + where, verdict_table(set), out, pair);
}

void add_real(const DataSet& set, std::string& out) {
  add("Table 4.3: real frames (" + set.name + ")", recording_table(set), out,
      "Percentages are mask consistency, Eq. (3.32): agreement with the image, not accuracy.");
  add("Frame by frame (" + set.name + ")", frame_table(set), out,
      "Mask consistency of what is valid, else why not.");
}

}  // namespace

std::string results_markdown(std::span<const Trial> trials, const std::string& how) {
  std::string out = "# Results\n\n" + how + "\n\n" + kScenesDiffer + "\n\n";
  for (const DataSet& set : data_sets_of(trials)) {
    out += fmt::format("## {}: {} frames\n\n", set.name, set.trials.size());
    const bool any_truth = std::any_of(set.trials.begin(), set.trials.end(),
                                       [](const Trial* trial) { return trial->with_truth; });
    const bool all_truth = std::all_of(set.trials.begin(), set.trials.end(),
                                       [](const Trial* trial) { return trial->with_truth; });
    if (any_truth) add_synthetic(set, out);
    if (!all_truth) add_real(set, out);
    add("Every method (" + set.name + ")", availability_table(set), out,
        "Mask consistency, Eq. (3.32), is the mean over what is valid; of a model, over all "
        "draws.");
  }
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace flowdlo::eval
