#include "gate_fit/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "eval/interval.hpp"
#include "eval/metrics.hpp"
#include "gate/one_rope.hpp"
#include "gate_fit/fit.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kFar_cm = 2;
constexpr std::size_t kBins = 10;

/// One sample's errors in cm, in the published direction as `flowdlo eval` takes them.
struct Row {
  const GateSample* sample = nullptr;
  double prior_cm = 0;
  double draw_cm = 0;  ///< of the first draw; the prior's where there is none
  double estimate_cm = 0;
  double oracle_priors_cm = 0;
  double oracle_cm = 0;
  bool left = false;  ///< the estimate is not the best prior
  bool predicted = false;
  bool close = false;
  double probability = 0;
  double one_sigma = 0;  ///< share of nodes
  double two_sigma = 0;
  double sigma_mm = 0;  ///< mean of the nodes
};

Row row_of(const GateSample& sample, const WeightsOf& weights_of) {
  const auto& candidates = sample.candidates;
  std::vector<double> published_cm;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    published_cm.push_back(100 * eval::index_error_m(sample.answer(i), sample.truth));
  }
  const gate::Choice choice = gate::choose_calibrated(candidates, weights_of(candidates));
  Row row;
  row.sample = &sample;
  row.prior_cm = row.draw_cm = 100 * eval::index_error_m(candidates[0].nodes, sample.truth);
  row.oracle_priors_cm = published_cm[0];
  for (std::size_t i = candidates.size(); i-- > 0;) {
    if (candidates[i].draw == 0) row.draw_cm = published_cm[i];
    if (candidates[i].draw >= 0) continue;
    row.oracle_priors_cm = std::min(row.oracle_priors_cm, published_cm[i]);
  }
  row.oracle_cm = *std::min_element(published_cm.begin(), published_cm.end());
  row.estimate_cm = published_cm[choice.chosen];
  row.left = choice.chosen != 0;
  row.predicted = candidates[choice.chosen].draw >= 0;
  row.close = errors_m(sample)[choice.chosen] < gate::kCloseError_m;
  row.probability = choice.probability;
  if (!sample.doubted.empty() && sample.doubted[choice.chosen] != 0) {
    row.probability = std::min(row.probability, static_cast<double>(gate::kDoubted));
  }
  const auto off_m = node_errors_m(sample.answer(choice.chosen), sample.truth);
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto sigma_m = static_cast<double>(choice.sigma_m[node]);
    row.one_sigma += off_m[node] <= sigma_m ? 1.0 / kNodes : 0;
    row.two_sigma += off_m[node] <= 2 * sigma_m ? 1.0 / kNodes : 0;
    row.sigma_mm += 1000 * sigma_m / kNodes;
  }
  return row;
}

double mean(const std::vector<Row>& rows, const std::function<double(const Row&)>& value) {
  double sum = 0;
  for (const Row& row : rows) sum += value(row);
  return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

std::vector<double> values(const std::vector<Row>& rows, double Row::*field) {
  std::vector<double> result;
  for (const Row& row : rows) result.push_back(row.*field);
  return result;
}

std::string group_line(const std::string& name, const std::vector<Row>& rows) {
  const auto over = [&](double Row::*field) {
    return 100 * mean(rows, [&](const Row& row) { return row.*field > kFar_cm ? 1.0 : 0.0; });
  };
  const auto average = [&](double Row::*field) {
    return mean(rows, [&](const Row& row) { return row.*field; });
  };
  const auto ratio =
      eval::ratio_interval(values(rows, &Row::estimate_cm), values(rows, &Row::prior_cm));
  return fmt::format(
      "| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} ({:.3f} to {:.3f}) | {:.1f} "
      "% | {:.1f} % | {:.1f} % | {:.1f} % |\n",
      name, rows.size(), average(&Row::prior_cm), average(&Row::draw_cm),
      average(&Row::estimate_cm), average(&Row::oracle_priors_cm), average(&Row::oracle_cm),
      ratio.value, ratio.low, ratio.high, over(&Row::prior_cm), over(&Row::estimate_cm),
      100 * mean(rows, [](const Row& row) { return row.left ? 1.0 : 0.0; }),
      100 * mean(rows, [](const Row& row) { return row.predicted ? 1.0 : 0.0; }));
}

double median(std::vector<double> values) {
  return values.empty() ? 0 : geometry::median_of(values);
}

/// Coverage and width of sigma_m in tenths of the scenes, least confident first.
std::string sharpness(std::vector<Row> rows) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.probability < b.probability; });
  std::string text =
      "\n| confidence | within one sigma_m | within two | median sigma_m, mm "
      "|\n|---|---|---|---|\n";
  for (std::size_t tenth = 0; tenth < kBins; ++tenth) {
    const std::vector<Row> part(
        rows.begin() + static_cast<std::ptrdiff_t>(rows.size() * tenth / kBins),
        rows.begin() + static_cast<std::ptrdiff_t>(rows.size() * (tenth + 1) / kBins));
    if (part.empty()) continue;
    text += fmt::format("| {:.3f} | {:.1f} % | {:.1f} % | {:.2f} |\n",
                        mean(part, [](const Row& row) { return row.probability; }),
                        100 * mean(part, [](const Row& row) { return row.one_sigma; }),
                        100 * mean(part, [](const Row& row) { return row.two_sigma; }),
                        median(values(part, &Row::sigma_mm)));
  }
  std::erase_if(rows, [](const Row& row) { return !row.close; });
  return text + fmt::format(
                    "\nOf the {} scenes under 1 cm sigma_m is {:.2f} mm in the mean, {:.2f} in the "
                    "median.\n",
                    rows.size(), mean(rows, [](const Row& row) { return row.sigma_mm; }),
                    median(values(rows, &Row::sigma_mm)));
}

std::string calibration(const std::vector<Row>& rows) {
  struct Bin {
    int scenes = 0;
    int close = 0;
    double sum = 0;
  };
  std::array<Bin, kBins> bins;
  for (const Row& row : rows) {
    Bin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(row.probability * kBins))];
    ++bin.scenes;
    bin.close += row.close ? 1 : 0;
    bin.sum += row.probability;
  }
  std::string text = "\n| confidence | scenes | index error under 1 cm |\n|---|---|---|\n";
  double off = 0;
  for (const Bin& bin : bins) {
    if (bin.scenes == 0) continue;
    const double was = static_cast<double>(bin.close) / bin.scenes;
    off += std::abs(bin.sum - bin.close) / static_cast<double>(rows.size());
    text +=
        fmt::format("| {:.2f} | {} | {:.1f} % |\n", bin.sum / bin.scenes, bin.scenes, 100 * was);
  }
  const auto share = [&](double Row::*field) {
    const auto interval = eval::mean_interval(values(rows, field));
    return fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100 * interval.value, 100 * interval.low,
                       100 * interval.high);
  };
  return text +
         fmt::format(
             "\nExpected calibration error {:.3f}. Nodes within one sigma_m: {}, within two: "
             "{}.\n",
             off, share(&Row::one_sigma), share(&Row::two_sigma));
}

}  // namespace

std::string report(const std::vector<GateSample>& samples, const WeightsOf& weights_of) {
  std::map<std::string, std::vector<Row>> groups;
  for (const GateSample& sample : samples) {
    const Row row = row_of(sample, weights_of);
    groups[" all"].push_back(row);
    groups[sample.easy ? " easy" : sample.hard ? " hard" : " middle"].push_back(row);
    groups[sample.scenario].push_back(row);
  }
  std::string text =
      "| group | scenes | prior cm | first draw | estimate | oracle of priors | oracle | estimate "
      "/ "
      "prior | prior > 2 cm | estimate > 2 cm | prior left | predictions |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, rows] : groups) {
    text += group_line(name.starts_with(' ') ? name.substr(1) : name, rows);
  }
  return text + calibration(groups[" all"]) + sharpness(groups[" all"]);
}

}  // namespace flowdlo::lab
