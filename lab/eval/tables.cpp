#include "eval/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "eval/interval.hpp"

namespace flowdlo::eval {
namespace {

constexpr double kCm = 100;
constexpr double kFar_m = 0.02;    // an error beyond this is a failure
constexpr double kClose_m = 0.01;  // one below this is a success, which `confidence` predicts
constexpr std::size_t kBins = 10;

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

// The trials whose every method can be compared.
Subset measured(std::span<const Trial> trials) {
  Subset subset;
  for (const Trial& trial : trials) {
    const bool whole = std::all_of(kMethods.begin(), kMethods.end(), [&](const Method& method) {
      return trial.of(method.key) != nullptr;
    });
    if (whole) subset.push_back(&trial);
  }
  return subset;
}

template <class Keep>
Subset kept(const Subset& trials, const Keep& keep) {
  Subset subset;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(subset),
               [&](const Trial* trial) { return keep(*trial); });
  return subset;
}

// The groups of the tables: all, by difficulty, by scenario.
std::vector<std::pair<std::string, Subset>> groups_of(const Subset& trials) {
  std::vector<std::pair<std::string, Subset>> groups{{"all", trials}};
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

std::vector<double> values(const Subset& trials, const char* method, double Outcome::*field) {
  std::vector<double> result;
  for (const Trial* trial : trials) result.push_back(trial->of(method)->*field);
  return result;
}

double mean(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return numbers.empty() ? 0 : sum / static_cast<double>(numbers.size());
}

double percentile(std::vector<double> numbers, double share) {
  if (numbers.empty()) return 0;
  std::sort(numbers.begin(), numbers.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(numbers.size()));
  return numbers[std::min(at, numbers.size() - 1)];
}

double share_beyond(const std::vector<double>& numbers, double limit) {
  const auto beyond =
      std::count_if(numbers.begin(), numbers.end(), [&](double number) { return number > limit; });
  return numbers.empty() ? 0 : static_cast<double>(beyond) / static_cast<double>(numbers.size());
}

void add_errors(const std::vector<std::pair<std::string, Subset>>& groups, std::string& out) {
  out +=
      "## Errors\n\nMean index error (Eq. 4.1) / mean discrete Frechet distance (Eq. 4.2), cm, "
      "both in the published direction.\n\n| group | n |";
  std::string rule = "\n|---|---|";
  for (const Method& method : kMethods) {
    out += fmt::format(" {} |", method.title);
    rule += "---|";
  }
  out += rule + "\n";
  for (const auto& [name, trials] : groups) {
    out += fmt::format("| {} | {} |", name, trials.size());
    for (const Method& method : kMethods) {
      out += fmt::format(" {:.3f} / {:.3f} |",
                         kCm * mean(values(trials, method.key, &Outcome::index_m)),
                         kCm * mean(values(trials, method.key, &Outcome::frechet_m)));
    }
    out += "\n";
  }
}

void add_ratios(const std::vector<std::pair<std::string, Subset>>& groups, std::string& out) {
  out +=
      "\n## Against the refined prior\n\nRatio of mean index errors with its 95 % bootstrap "
      "interval over scenes: below 1 is better.\n\n| group | n | model | estimate | oracle "
      "|\n|---|---|---|---|---|\n";
  for (const auto& [name, trials] : groups) {
    const auto under = values(trials, kAgainst, &Outcome::index_m);
    out += fmt::format("| {} | {} |", name, trials.size());
    for (const char* method : {"model", "estimate", "oracle"}) {
      const Interval ratio = ratio_interval(values(trials, method, &Outcome::index_m), under);
      out += fmt::format(" {:.3f} [{:.3f}, {:.3f}] |", ratio.value, ratio.low, ratio.high);
    }
    out += "\n";
  }
}

void add_spread(const Subset& trials, std::string& out) {
  out +=
      "\n## Spread\n\nIndex error, cm, its mean with the 95 % bootstrap interval; flips: the "
      "ends are the other way round; strand errors: nodes over a tenth of the length astray."
      "\n\n| method | mean | median | 95 % | over 2 cm | either way, mean | flips | strand "
      "errors |\n|---|---|---|---|---|---|---|---|\n";
  for (const Method& method : kMethods) {
    const auto index = values(trials, method.key, &Outcome::index_m);
    const Interval interval = mean_interval(index);
    out += fmt::format(
        "| {} | {:.3f} [{:.3f}, {:.3f}] | {:.3f} | {:.3f} | {:.1f} % | {:.3f} | "
        "{:.1f} % | {:.2f} % |\n",
        method.title, kCm * interval.value, kCm * interval.low, kCm * interval.high,
        kCm * percentile(index, 0.5), kCm * percentile(index, 0.95),
        100 * share_beyond(index, kFar_m),
        kCm * mean(values(trials, method.key, &Outcome::either_index_m)),
        100 * mean(values(trials, method.key, &Outcome::flips)),
        100 * mean(values(trials, method.key, &Outcome::strand_errors)));
  }
}

void add_calibration(const Subset& trials, std::string& out) {
  struct Bin {
    int scenes = 0;
    int close = 0;
    double sum = 0;
  };
  std::array<Bin, kBins> bins;
  double one = 0;
  double two = 0;
  for (const Trial* trial : trials) {
    const double at = std::clamp(trial->confidence, 0.0, 1.0);
    Bin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(at * kBins))];
    ++bin.scenes;
    bin.close += trial->of("estimate")->either_index_m < kClose_m ? 1 : 0;
    bin.sum += at;
    one += trial->sigma.one / static_cast<double>(trials.size());
    two += trial->sigma.two / static_cast<double>(trials.size());
  }
  out += "\n## Calibration\n\n| confidence | scenes | index error under 1 cm |\n|---|---|---|\n";
  double off = 0;
  for (const Bin& bin : bins) {
    if (bin.scenes == 0) continue;
    const double said = bin.sum / bin.scenes;
    const double was = static_cast<double>(bin.close) / bin.scenes;
    off += std::abs(said - was) * bin.scenes / static_cast<double>(trials.size());
    out += fmt::format("| {:.2f} | {} | {:.1f} % |\n", said, bin.scenes, 100 * was);
  }
  out += fmt::format(
      "\nExpected calibration error {:.3f}. Nodes within one sigma_m of the truth: "
      "{:.1f} %, within two: {:.1f} % (calibrated: 68 %, 95 %).\n",
      off, 100 * one, 100 * two);
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
      "\n## Coverage\n\n{} of {} frames have an estimate, {} have a truth. {} "
      "estimates are predictions; the gate accepted {} of {} draws. Mask agreement "
      "of the estimates {:.3f}.\n",
      answered, trials.size(), with_truth, predictions, accepted, draws,
      answered > 0 ? agreement / answered : 0);
  if (!failures.empty()) out += "\nWithout an estimate:\n" + failures + "\n";
}

// A field of a CSV file: quoted where it has to be.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"') result += '"';
    result += letter;
  }
  return result + "\"";
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
                       quoted(trial.name), quoted(trial.scene.scenario),
                       quoted(trial.scene.material), trial.scene.crossings, trial.scene.easy(),
                       trial.scene.hard(), quoted(trial.failure),
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
    if (trial.answered()) out += fmt::format("{},{:.2f}\n", quoted(trial.name), trial.total_ms);
  }
  return out;
}

std::string timing_sentence(std::span<const Trial> trials) {
  std::vector<double> total_ms;
  for (const Trial& trial : trials) {
    if (trial.answered()) total_ms.push_back(trial.total_ms);
  }
  if (total_ms.empty()) return {};
  return fmt::format("Time a frame: median {:.1f} ms, 95 % under {:.1f} ms.\n",
                     percentile(total_ms, 0.5), percentile(total_ms, 0.95));
}

std::string tables_markdown(std::span<const Trial> trials) {
  std::string out;
  const Subset subset = measured(trials);
  if (!subset.empty()) {
    const auto groups = groups_of(subset);
    add_errors(groups, out);
    add_ratios(groups, out);
    add_spread(subset, out);
    add_calibration(subset, out);
  }
  add_coverage(trials, out);
  out += "\nThe scenes are our own, not those of the thesis: figures of the two do not compare.\n";
  return out;
}

}  // namespace flowdlo::eval
