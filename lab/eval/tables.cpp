#include "eval/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "eval/coverage_tables.hpp"
#include "eval/interval.hpp"
#include "eval/method_rows.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::eval {
namespace {

using survey::Values;

constexpr double kCm = 100;
constexpr double kFar_cm = 2;     // an error beyond this is a failure
constexpr double kClose_cm = 1;   // one below this is a success, which `confidence` predicts
constexpr double kTrusted = 0.5;  // a confidence that a program would go by

struct Method {
  const char* key;
  const char* title;
};
constexpr std::array<Method, 5> kMethods{{{"prior", "thesis prior"},
                                          {"refined", "refined prior"},
                                          {"model", "model, every draw"},
                                          {"estimate", "estimate (gate)"},
                                          {"oracle", "oracle"}}};
constexpr const char* kAgainst = "refined";

using Subset = std::vector<const Trial*>;
using Groups = std::vector<std::pair<std::string, Subset>>;

// The trials whose every method can be compared.
Subset measured(std::span<const Trial> trials) {
  Subset all;
  for (const Trial& trial : trials) all.push_back(&trial);
  std::vector<std::string> methods;
  for (const Method& method : kMethods) methods.emplace_back(method.key);
  return having(all, methods);
}

template <class Keep>
Subset kept(const Subset& trials, const Keep& keep) {
  Subset subset;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(subset),
               [&](const Trial* trial) { return keep(*trial); });
  return subset;
}

// The groups of the tables: all, by difficulty, by scenario.
Groups groups_of(const Subset& trials) {
  Groups groups{{"all", trials}};
  const auto add = [&](const std::string& name, Subset subset) {
    if (!subset.empty()) groups.emplace_back(name, std::move(subset));
  };
  add("easy (no crossing, gap or bad depth)",
      kept(trials, [](const Trial& trial) { return trial.scene.easy(); }));
  add("hard (gap, touch, coil or holes)",
      kept(trials, [](const Trial& trial) { return trial.scene.hard(); }));
  add("crossings", kept(trials, [](const Trial& trial) { return trial.scene.crossings > 0; }));
  std::map<std::string, Subset> scenarios;
  for (const Trial* trial : trials) scenarios[trial->scene.scenario].push_back(trial);
  for (auto& [name, subset] : scenarios) add(name, std::move(subset));
  return groups;
}

Values values(const Subset& trials, const char* method, double Outcome::*field) {
  Values result;
  for (const Trial* trial : trials) result.add(trial->of(method)->*field);
  return result;
}

Values in_cm(const Values& metres) {
  Values result;
  for (const double m : metres.all()) result.add(kCm * m);
  return result;
}

std::string error_table(const Groups& groups) {
  std::vector<std::string> header{"group", "n"};
  for (const Method& method : kMethods) header.emplace_back(method.title);
  survey::Table table(header);
  for (const auto& [name, trials] : groups) {
    std::vector<std::string> cells{name, std::to_string(trials.size())};
    for (const Method& method : kMethods) cells.push_back(cell(mean_error(trials, method.key)));
    table.add(std::move(cells));
  }
  return "## Errors\n\nMean index error (Eq. 4.1) / mean discrete Frechet distance (Eq. 4.2), cm, "
         "both in the published direction.\n\n" +
         table.text();
}

std::string ratio_table(const Groups& groups) {
  survey::Table table({"group", "n", "model", "estimate", "oracle"});
  for (const auto& [name, trials] : groups) {
    const auto under = values(trials, kAgainst, &Outcome::index_m);
    std::vector<std::string> cells{name, std::to_string(trials.size())};
    for (const char* method : {"model", "estimate", "oracle"}) {
      const Interval ratio =
          ratio_interval(values(trials, method, &Outcome::index_m).all(), under.all());
      cells.push_back(fmt::format("{:.3f} [{:.3f}, {:.3f}]", ratio.value, ratio.low, ratio.high));
    }
    table.add(std::move(cells));
  }
  return "## Against the refined prior\n\nRatio of mean index errors with its 95 % bootstrap "
         "interval over scenes: below 1 is better.\n\n" +
         table.text();
}

std::string spread_table(const Subset& trials) {
  survey::Table table({"method", "mean", "median", "95 %", "over 2 cm", "either way, mean", "flips",
                       "strand errors"});
  for (const Method& method : kMethods) {
    const Values cm = in_cm(values(trials, method.key, &Outcome::index_m));
    const Interval mean = mean_interval(cm.all());
    const auto mean_of = [&](double Outcome::*field) {
      return values(trials, method.key, field).mean();
    };
    table.add({method.title,
               fmt::format("{:.3f} [{:.3f}, {:.3f}]", mean.value, mean.low, mean.high),
               fmt::format("{:.3f}", cm.median()), fmt::format("{:.3f}", cm.quantile(0.95)),
               fmt::format("{:.1f} %", cm.percent_over(kFar_cm)),
               fmt::format("{:.3f}", kCm * mean_of(&Outcome::either_index_m)),
               fmt::format("{:.1f} %", 100 * mean_of(&Outcome::flips)),
               fmt::format("{:.2f} %", 100 * mean_of(&Outcome::strand_errors))});
  }
  return "## Spread\n\nIndex error, cm, its mean with the 95 % bootstrap interval; flips: the "
         "ends are the other way round; strand errors: nodes over a tenth of the length astray."
         "\n\n" +
         table.text();
}

std::string trust_table(const Groups& groups) {
  survey::Table table({"group", "n", "under 1 cm", "mean / median / 95 %", "flips",
                       "of those 1 cm off or more: confidence below 0.5",
                       "of those under 1 cm: confidence 0.5 or more"});
  for (const auto& [name, trials] : groups) {
    const Values cm = in_cm(values(trials, "estimate", &Outcome::either_index_m));
    int close = 0, trusted = 0, doubted = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const bool sure = trials[i]->confidence >= kTrusted;
      const bool near = cm.all()[i] < kClose_cm;
      close += near ? 1 : 0;
      trusted += near && sure ? 1 : 0;
      doubted += near || sure ? 0 : 1;
    }
    const auto n = static_cast<int>(trials.size());
    table.add({name, std::to_string(n), fmt::format("{:.1f} %", survey::percent(close, n)),
               fmt::format("{:.3f} / {:.3f} / {:.3f}", cm.mean(), cm.median(), cm.quantile(0.95)),
               fmt::format("{:.0f}", n * values(trials, "estimate", &Outcome::flips).mean()),
               fmt::format("{} of {}", doubted, n - close),
               fmt::format("{:.1f} %", survey::percent(trusted, close))});
  }
  return "## The estimate, and what its confidence says\n\nIndex error, cm, in the better "
         "direction.\n\n" +
         table.text();
}

void add_coverage(std::span<const Trial> trials, std::string& out) {
  int answered = 0;
  int with_truth = 0;
  int predictions = 0;
  int accepted = 0;
  int draws = 0;
  double agreement = 0;
  std::string failures;
  for (const Trial& trial : trials) {
    with_truth += trial.with_truth ? 1 : 0;
    if (!trial.answered()) {
      failures += fmt::format("\n- {}: {}", trial.name, trial.failure);
      continue;
    }
    ++answered;
    predictions += trial.source == Source::kPrediction ? 1 : 0;
    accepted += trial.accepted_draws;
    draws += trial.draws;
    agreement += trial.mask_agreement;
  }
  out += fmt::format(
      "## Coverage\n\n{} of {} frames have an estimate, {} have a truth. {} "
      "estimates are predictions; the gate accepted {} of {} draws. Mask agreement "
      "of the estimates {:.3f}.\n",
      answered, trials.size(), with_truth, predictions, accepted, draws,
      answered > 0 ? agreement / answered : 0);
  if (!failures.empty()) out += "\nWithout an estimate:\n" + failures + "\n";
}

}  // namespace

std::string rows_csv(std::span<const Trial> trials) {
  std::string out =
      "frame,scenario,material,crossings,easy,hard,failure,source,draws,accepted,"
      "confidence,mask_agreement,sigma_one,sigma_two";
  for (const Method& method : kMethods) {
    out += fmt::format(",{0}_index_cm,{0}_frechet_cm,{0}_either_cm,{0}_flips,{0}_strand_errors",
                       method.key);
  }
  out += "\n";
  for (const Trial& trial : trials) {
    out += fmt::format("{},{},{},{},{:d},{:d},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}",
                       csv_field(trial.name), csv_field(trial.scene.scenario),
                       csv_field(trial.scene.material), trial.scene.crossings, trial.scene.easy(),
                       trial.scene.hard(), csv_field(trial.failure),
                       trial.source == Source::kPrediction ? "prediction" : "prior", trial.draws,
                       trial.accepted_draws, trial.confidence, trial.mask_agreement,
                       trial.sigma.one, trial.sigma.two);
    for (const Method& method : kMethods) {
      const Outcome* outcome = trial.of(method.key);
      if (outcome == nullptr) {
        out += ",,,,,";
        continue;
      }
      out += fmt::format(",{:.5f},{:.5f},{:.5f},{:.4f},{:.4f}", kCm * outcome->index_m,
                         kCm * outcome->frechet_m, kCm * outcome->either_index_m, outcome->flips,
                         outcome->strand_errors);
    }
    out += "\n";
  }
  return out;
}

std::string timings_csv(std::span<const Trial> trials) {
  std::string out = "frame,total_ms\n";
  for (const Trial& trial : trials) {
    if (trial.answered()) out += fmt::format("{},{:.2f}\n", csv_field(trial.name), trial.total_ms);
  }
  return out;
}

std::string timing_sentence(std::span<const Trial> trials) {
  Values total_ms;
  for (const Trial& trial : trials) {
    if (trial.answered()) total_ms.add(trial.total_ms);
  }
  if (total_ms.count() == 0) return {};
  return fmt::format("Time a frame: median {:.1f} ms, 95 % under {:.1f} ms.\n", total_ms.median(),
                     total_ms.quantile(0.95));
}

std::string tables_markdown(std::span<const Trial> trials) {
  std::string out;
  const Subset subset = measured(trials);
  if (!subset.empty()) {
    const Groups groups = groups_of(subset);
    out += error_table(groups) + ratio_table(groups) + spread_table(subset) + trust_table(groups) +
           "## Calibration\n\n" + calibration_table(DataSet{"", subset, false});
  }
  add_coverage(trials, out);
  out += "\nThe scenes are our own, not those of the thesis: figures of the two do not compare.\n";
  return out;
}

}  // namespace flowdlo::eval
