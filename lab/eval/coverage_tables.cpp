#include "eval/coverage_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "survey/table.hpp"

namespace flowdlo::eval {
namespace {

constexpr double kClose_m = 0.01;
constexpr std::size_t kBins = 10;

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

struct Tally {
  int frames = 0;
  int valid = 0;
  int invalid = 0;
  int none = 0;
  int draws = 0;
  int accepted = 0;
  double agreement = 0;  // mean over what is valid
  std::map<std::string, int> reasons;
};

Tally tally_of(const std::vector<const Trial*>& trials, const std::string& method) {
  Tally tally;
  for (const Trial* trial : trials) {
    const Account* account = trial->account(method);
    if (account == nullptr) continue;
    ++tally.frames;
    if (!account->valid()) {
      ++(account->output ? tally.invalid : tally.none);
      ++tally.reasons[account->failure];
      continue;
    }
    ++tally.valid;
    tally.draws += account->draws;
    tally.accepted += account->accepted;
    tally.agreement += account->mask_agreement;
  }
  if (tally.valid > 0) tally.agreement /= tally.valid;
  return tally;
}

// Every method with an account, the estimate first; parts and sweeps of models left out.
std::vector<std::string> methods_of(const std::vector<const Trial*>& trials) {
  std::set<std::string> names;
  for (const Trial* trial : trials) {
    for (const auto& [name, account] : trial->accounts) {
      if (name.find_first_of(".@") == std::string::npos) names.insert(name);
    }
  }
  std::vector<std::string> ordered;
  for (const char* first : {"estimate", "model", "prior"}) {
    if (names.erase(first) > 0) ordered.emplace_back(first);
  }
  ordered.insert(ordered.end(), names.begin(), names.end());
  return ordered;
}

std::string word_for(const Trial& trial, const std::string& method) {
  const Account* account = trial.account(method);
  if (account == nullptr) return "-";
  if (account->valid()) return percent(account->mask_agreement);
  return (account->output ? "invalid: " : "no output: ") + account->failure;
}

std::string percent_or_dash(const std::optional<double>& value) {
  return value ? fmt::format("*{:.1f} %*", *value) : "*-*";
}

}  // namespace

std::string availability_table(const DataSet& data_set) {
  survey::Table table({"method", "frames", "valid", "invalid", "no output", "mask consistency",
                       "index / Frechet, cm, where valid", "strand errors", "reasons"});
  for (const std::string& method : methods_of(data_set.trials)) {
    const Tally tally = tally_of(data_set.trials, method);
    std::string reasons;
    for (const auto& [reason, count] : tally.reasons) {
      reasons += fmt::format("{}{} x {}", reasons.empty() ? "" : "; ", count, reason);
    }
    double strands = 0;
    const auto measured = having(data_set.trials, {method});
    for (const Trial* trial : measured) {
      strands += trial->of(method)->strand_errors / static_cast<double>(measured.size());
    }
    table.add({method, std::to_string(tally.frames), std::to_string(tally.valid),
               std::to_string(tally.invalid), std::to_string(tally.none),
               tally.valid > 0 ? percent(tally.agreement) : "-",
               cell(mean_error(data_set.trials, method)), measured.empty() ? "-" : percent(strands),
               reasons});
  }
  return table.text();
}

std::string frame_table(const DataSet& data_set) {
  std::vector<std::string> header{"frame", "accepted draws", "confidence"};
  const auto methods = methods_of(data_set.trials);
  header.insert(header.end(), methods.begin(), methods.end());
  survey::Table table(header);
  for (const Trial* trial : data_set.trials) {
    std::vector<std::string> cells{trial->name,
                                   fmt::format("{} of {}", trial->accepted_draws, trial->draws),
                                   fmt::format("{:.2f}", trial->confidence)};
    for (const std::string& method : methods) cells.push_back(word_for(*trial, method));
    table.add(std::move(cells));
  }
  return table.text();
}

std::string recording_table(const DataSet& data_set) {
  std::vector<const Trial*> real;
  std::copy_if(data_set.trials.begin(), data_set.trials.end(), std::back_inserter(real),
               [](const Trial* trial) { return !trial->with_truth; });
  if (real.empty()) return {};
  survey::Table table({"recording", "frames", "TrackDLO-init valid / no output / invalid",
                       "eligible", "draws accepted", "TrackDLO-init", "prediction", "prior",
                       "estimate"});
  const Tally trackdlo = tally_of(real, "trackdlo");
  const Tally model = tally_of(real, "model");
  const Tally prior = tally_of(real, "prior");
  const Tally estimate = tally_of(real, "estimate");
  const auto agreement = [](const Tally& tally) {
    return tally.valid > 0 ? percent(tally.agreement) : "-";
  };
  table.add({data_set.name, std::to_string(real.size()),
             trackdlo.frames > 0
                 ? fmt::format("{} / {} / {}", trackdlo.valid, trackdlo.none, trackdlo.invalid)
                 : "-",
             fmt::format("{} of {}", prior.valid, real.size()),
             fmt::format("{} of {}", model.accepted, model.draws), agreement(trackdlo),
             agreement(model), agreement(prior), agreement(estimate)});
  for (const ThesisRecording& row : thesis_recordings()) {
    const int draws = 4 * row.eligible;
    table.add({fmt::format("*thesis: {}*", row.name), fmt::format("*{}*", row.frames),
               fmt::format("*{} / {} / {}*", row.valid, row.no_output, row.invalid),
               fmt::format("*{} of {}*", row.eligible, row.frames), fmt::format("*0 of {}*", draws),
               percent_or_dash(row.trackdlo_percent), percent_or_dash(row.prediction_percent),
               percent_or_dash(row.prior_percent), percent_or_dash(row.prior_percent)});
  }
  return table.text();
}

std::vector<ReliabilityBin> reliability(const std::vector<const Trial*>& trials) {
  std::array<ReliabilityBin, kBins> bins;
  for (const Trial* trial : trials) {
    const Outcome* estimate = trial->of("estimate");
    if (estimate == nullptr) continue;
    const double said = std::clamp(trial->confidence, 0.0, 1.0);
    ReliabilityBin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(said * kBins))];
    ++bin.scenes;
    bin.said += said;
    bin.was += estimate->either_index_m < kClose_m ? 1 : 0;
  }
  std::vector<ReliabilityBin> filled;
  for (ReliabilityBin bin : bins) {
    if (bin.scenes == 0) continue;
    bin.said /= bin.scenes;
    bin.was /= bin.scenes;
    filled.push_back(bin);
  }
  return filled;
}

double expected_calibration_error(const std::vector<ReliabilityBin>& bins) {
  int scenes = 0;
  double sum = 0;
  for (const ReliabilityBin& bin : bins) {
    scenes += bin.scenes;
    sum += bin.scenes * std::abs(bin.said - bin.was);
  }
  return scenes > 0 ? sum / scenes : 0;
}

std::string calibration_table(const DataSet& data_set) {
  const auto bins = reliability(data_set.trials);
  if (bins.empty()) return {};
  survey::Table table({"confidence", "scenes", "index error under 1 cm"});
  for (const ReliabilityBin& bin : bins) {
    table.add({fmt::format("{:.2f}", bin.said), std::to_string(bin.scenes), percent(bin.was)});
  }
  double one = 0;
  double two = 0;
  const auto measured = having(data_set.trials, {"estimate"});
  for (const Trial* trial : measured) {
    one += trial->sigma.one / static_cast<double>(measured.size());
    two += trial->sigma.two / static_cast<double>(measured.size());
  }
  return table.text() +
         fmt::format(
             "Expected calibration error {:.3f}. Nodes within one `sigma_m` of the truth: {:.1f} "
             "%, within two: {:.1f} % (of a normal error: 68 %, 95 %).\n\n",
             expected_calibration_error(bins), 100 * one, 100 * two);
}

}  // namespace flowdlo::eval
