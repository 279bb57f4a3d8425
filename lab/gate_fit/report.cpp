#include "gate_fit/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "eval/interval.hpp"
#include "eval/metrics.hpp"
#include "gate/one_rope.hpp"
#include "gate_fit/fit.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

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

using survey::Values;

Values values(const std::vector<Row>& rows, const std::function<double(const Row&)>& value) {
  Values result;
  for (const Row& row : rows) result.add(value(row));
  return result;
}

/// In percent.
double share(const std::vector<Row>& rows, bool Row::*field) {
  return values(rows, [&](const Row& row) { return row.*field ? 100.0 : 0.0; }).mean();
}

void add_group(const std::string& name, const std::vector<Row>& rows, survey::Table& table) {
  std::vector<std::string> cells{name, std::to_string(rows.size())};
  for (double Row::*const field : {&Row::prior_cm, &Row::draw_cm, &Row::estimate_cm,
                                   &Row::oracle_priors_cm, &Row::oracle_cm}) {
    cells.push_back(fmt::format("{:.3f}", values(rows, std::mem_fn(field)).mean()));
  }
  const Values prior = values(rows, std::mem_fn(&Row::prior_cm));
  const Values estimate = values(rows, std::mem_fn(&Row::estimate_cm));
  const auto ratio = eval::ratio_interval(estimate.all(), prior.all());
  cells.push_back(fmt::format("{:.3f} ({:.3f} to {:.3f})", ratio.value, ratio.low, ratio.high));
  for (const double percent : {prior.percent_over(kFar_cm), estimate.percent_over(kFar_cm),
                               share(rows, &Row::left), share(rows, &Row::predicted)}) {
    cells.push_back(fmt::format("{:.1f} %", percent));
  }
  table.add(std::move(cells));
}

/// Coverage and width of sigma_m in tenths of the scenes, least confident first.
std::string sharpness(std::vector<Row> rows) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.probability < b.probability; });
  survey::Table table({"confidence", "within one sigma_m", "within two", "median sigma_m, mm"});
  for (std::size_t tenth = 0; tenth < kBins; ++tenth) {
    const std::vector<Row> part(
        rows.begin() + static_cast<std::ptrdiff_t>(rows.size() * tenth / kBins),
        rows.begin() + static_cast<std::ptrdiff_t>(rows.size() * (tenth + 1) / kBins));
    if (part.empty()) continue;
    const auto mean = [&](double Row::*field) { return values(part, std::mem_fn(field)).mean(); };
    table.add({fmt::format("{:.3f}", mean(&Row::probability)),
               fmt::format("{:.1f} %", 100 * mean(&Row::one_sigma)),
               fmt::format("{:.1f} %", 100 * mean(&Row::two_sigma)),
               fmt::format("{:.2f}", values(part, std::mem_fn(&Row::sigma_mm)).median())});
  }
  std::erase_if(rows, [](const Row& row) { return !row.close; });
  const Values sigma_mm = values(rows, std::mem_fn(&Row::sigma_mm));
  return table.text() + fmt::format(
                            "Of the {} scenes under 1 cm sigma_m is {:.2f} mm in the mean, {:.2f} "
                            "in the median.\n",
                            rows.size(), sigma_mm.mean(), sigma_mm.median());
}

std::string calibration(const std::vector<Row>& rows) {
  std::array<std::vector<Row>, kBins> bins;
  for (const Row& row : rows) {
    bins[std::min(kBins - 1, static_cast<std::size_t>(row.probability * kBins))].push_back(row);
  }
  survey::Table table({"confidence", "scenes", "index error under 1 cm"});
  double off = 0;
  for (const auto& bin : bins) {
    if (bin.empty()) continue;
    const double said = values(bin, std::mem_fn(&Row::probability)).mean();
    const double was = share(bin, &Row::close);
    off += std::abs(said - was / 100) *
           survey::percent(static_cast<double>(bin.size()), static_cast<double>(rows.size())) / 100;
    table.add(
        {fmt::format("{:.2f}", said), std::to_string(bin.size()), fmt::format("{:.1f} %", was)});
  }
  const auto interval_of = [&](double Row::*field) {
    const auto interval = eval::mean_interval(values(rows, std::mem_fn(field)).all());
    return fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100 * interval.value, 100 * interval.low,
                       100 * interval.high);
  };
  return table.text() +
         fmt::format(
             "Expected calibration error {:.3f}. Nodes within one sigma_m: {}, within two: {}.\n\n",
             off, interval_of(&Row::one_sigma), interval_of(&Row::two_sigma));
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
  survey::Table table({"group", "scenes", "prior cm", "first draw", "estimate", "oracle of priors",
                       "oracle", "estimate / prior", "prior > 2 cm", "estimate > 2 cm",
                       "prior left", "predictions"});
  for (const auto& [name, rows] : groups) {
    add_group(name.starts_with(' ') ? name.substr(1) : name, rows, table);
  }
  return table.text() + calibration(groups[" all"]) + sharpness(groups[" all"]);
}

}  // namespace flowdlo::lab
