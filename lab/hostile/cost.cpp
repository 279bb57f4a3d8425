#include "hostile/cost.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <limits>

namespace flowdlo::lab {
namespace {

constexpr double kMegabyte = 1.0e6;

double cpu_now_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// From here on the kernel keeps the peak anew.
void forget_peak() {
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024 / kMegabyte;
  }
  return 0;
}

std::string verdict_on(const Error& error) {
  return fmt::format("{}: {}", name_of(error.code), error.message);
}

std::string verdict_on(const Result<Estimate>& estimate) {
  if (!estimate) return verdict_on(estimate.error());
  return fmt::format("confidence {:.2f}", estimate->confidence);
}

std::string verdict_on(const Result<Ropes>& found) {
  if (!found) return verdict_on(found.error());
  return fmt::format("{} ropes", found->ropes.size());
}

}  // namespace

Cost cost_of(const Frame& frame, Estimator& estimator, int rounds, Asked asked) {
  Cost cost{std::numeric_limits<double>::max(), 0, {}};
  forget_peak();
  for (int round = 0; round < rounds; ++round) {
    const double before = cpu_now_s();
    cost.verdict = asked == Asked::kSeveralRopes ? verdict_on(estimator.estimate_ropes(frame))
                                                 : verdict_on(estimator.estimate(frame));
    cost.cpu_s = std::min(cost.cpu_s, cpu_now_s() - before);
  }
  cost.peak_mb = peak_mb();
  return cost;
}

}  // namespace flowdlo::lab
