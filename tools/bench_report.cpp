#include "bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "flowdlo/version.hpp"

namespace flowdlo::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Stage {
  const char* name;
  double Timings::*time_ms;
};

constexpr std::array<Stage, 9> kStages = {{{"field", &Timings::field_ms},
                                           {"path", &Timings::path_ms},
                                           {"evidence", &Timings::evidence_ms},
                                           {"prior", &Timings::prior_ms},
                                           {"readings", &Timings::readings_ms},
                                           {"mask_field", &Timings::mask_field_ms},
                                           {"model", &Timings::model_ms},
                                           {"gate", &Timings::gate_ms},
                                           {"readings_beside", &Timings::beside_ms}}};

Percentiles percentiles_of_stage(const BenchReport& report, double Timings::*time_ms) {
  std::vector<double> values;
  for (const auto& timings : report.timings) values.push_back(timings.*time_ms);
  return percentiles_of(std::move(values));
}

using DeviceStages = std::vector<std::pair<std::string, Percentiles>>;

// In the order in which the device runs them.
DeviceStages percentiles_on_device(const BenchReport& report) {
  std::map<std::string, std::vector<double>> values;
  for (const auto& timings : report.timings) {
    for (const auto& [stage, time_ms] : timings.device_ms) values[stage].push_back(time_ms);
  }
  DeviceStages stages;
  if (report.timings.empty()) return stages;
  for (const auto& entry : report.timings.front().device_ms) {
    const auto found = values.find(entry.first);
    if (found == values.end()) continue;
    stages.emplace_back(entry.first, percentiles_of(found->second));
    values.erase(found);
  }
  return stages;
}

double rounded(double value) { return std::round(value * 1.0e4) / 1.0e4; }

Json json_of(const Percentiles& percentiles) {
  return {{"p50", rounded(percentiles.p50)},
          {"p95", rounded(percentiles.p95)},
          {"p99", rounded(percentiles.p99)},
          {"max", rounded(percentiles.most)}};
}

std::string row(const std::string& name, const Percentiles& percentiles) {
  return fmt::format("  {:<22} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, percentiles.p50,
                     percentiles.p95, percentiles.p99, percentiles.most);
}

}  // namespace

Percentiles percentiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share) {
    const double rank = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const auto above = std::min(below + 1, values.size() - 1);
    return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(0.50), at(0.95), at(0.99), values.back()};
}

std::string bench_json(const BenchReport& report) {
  Json json = {
      {"version", FLOWDLO_VERSION},
      {"frame", report.frame},
      {"width", report.width},
      {"height", report.height},
      {"device", report.device},
      {"field_device", report.field_device.empty() ? Json(nullptr) : Json(report.field_device)},
      {"threads", report.threads},
      {"draws", report.draws},
      {"steps", report.steps},
      {"frames", report.timings.size()},
      {"without_estimate", report.without_estimate},
      {"create_ms", rounded(report.create_ms)},
      {"first_ms", rounded(report.first_ms)},
      {"total_ms", json_of(percentiles_of_stage(report, &Timings::total_ms))}};
  for (const auto& stage : kStages) {
    json["stages_ms"][stage.name] = json_of(percentiles_of_stage(report, stage.time_ms));
  }
  json["device_stages_ms"] = Json::object();
  for (const auto& [name, percentiles] : percentiles_on_device(report)) {
    json["device_stages_ms"][name] = json_of(percentiles);
  }
  json["rss_mb"] = rounded(report.rss_mb);
  json["rss_peak_mb"] = rounded(report.rss_peak_mb);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string bench_table(const BenchReport& report) {
  const bool elsewhere = !report.field_device.empty() && report.field_device != report.device;
  const bool on_cpu = report.device == "cpu" || report.field_device == "cpu";
  std::string text = fmt::format(
      "{}, {} x {} px, {} draws, {} steps, on {}{}{}\n", report.frame, report.width, report.height,
      report.draws, report.steps, report.device,
      elsewhere ? fmt::format(", strand field on {}", report.field_device) : std::string(),
      on_cpu ? fmt::format(", {} threads", report.threads) : std::string());
  text +=
      fmt::format("create {:.1f} ms, first frame {:.1f} ms, memory {:.0f} MB (peak {:.0f} MB)\n\n",
                  report.create_ms, report.first_ms, report.rss_mb, report.rss_peak_mb);
  if (report.without_estimate > 0) {
    text += fmt::format("{} more calls came to no estimate\n\n", report.without_estimate);
  }
  text += fmt::format("  {:<22} {:>10} {:>10} {:>10} {:>10}\n",
                      fmt::format("ms over {} frames", report.timings.size()), "p50", "p95", "p99",
                      "max");
  for (const auto& stage : kStages) {
    text += row(stage.name, percentiles_of_stage(report, stage.time_ms));
  }
  text += row("total", percentiles_of_stage(report, &Timings::total_ms));
  const auto on_device = percentiles_on_device(report);
  if (!on_device.empty()) text += "\n  on the device\n";
  for (const auto& [name, percentiles] : on_device) text += row(name, percentiles);
  return text;
}

}  // namespace flowdlo::tools
