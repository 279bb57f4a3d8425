// BenchReport: what `flowdlo bench` measured, as JSON and as a table.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "flowdlo/estimate.hpp"

namespace flowdlo::tools {

struct Percentiles {
  double p50 = 0;
  double p95 = 0;
  double p99 = 0;
  double most = 0;
};

/// Linear between the two nearest ranks; zeros when there are no values.
[[nodiscard]] Percentiles percentiles_of(std::vector<double> values);

struct BenchReport {
  std::string frame;  ///< or the set, with the number of its frames
  int width = 0;      ///< of the first frame
  int height = 0;
  std::string device;
  std::string field_device;
  int threads = 0;  ///< of the CPU back end
  int draws = 0;
  int steps = 0;
  double create_ms = 0;
  double first_ms = 0;           ///< the first call, which is in none of the percentiles
  std::vector<Timings> timings;  ///< of the calls after it, as far as they came to an estimate
  int without_estimate = 0;      ///< the other calls
  double rss_mb = 0;             ///< resident memory at the end
  double rss_peak_mb = 0;
};

/// Fields of spec section 3, every time in milliseconds.
[[nodiscard]] std::string bench_json(const BenchReport& report);
[[nodiscard]] std::string bench_table(const BenchReport& report);

}  // namespace flowdlo::tools
