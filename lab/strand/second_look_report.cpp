// flowdlo_second_look_report: which further readings of a doubtful mask are worth their time, by
// the centerlines that they bring forth, before any model or gate, on `wide` scenes with truth.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "estimator/conditions.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "field/axes.hpp"
#include "path/readings.hpp"
#include "path/strand_reading.hpp"
#include "strand/scene_range.hpp"
#include "synth/synthetic_frame.hpp"

namespace {

namespace estimator = flowdlo::estimator;
namespace field = flowdlo::field;
namespace path = flowdlo::path;
namespace synth = flowdlo::synth;

constexpr std::size_t kOfEach = 2;  // hypotheses of a reading that the estimator takes
constexpr double kNothing_cm = 99;  // where a reading fails
constexpr double kFarOff_cm = 2;

constexpr std::array kMaskReadings{path::Reading::kHalved, path::Reading::kDoubled,
                                   path::Reading::kEroded, path::Reading::kDilated,
                                   path::Reading::kMeasured};
constexpr std::size_t kAsGiven = kMaskReadings.size();
constexpr std::size_t kField = kAsGiven + 1;
constexpr std::size_t kWays = kField + 1;
constexpr std::array<const char*, kWays> kNames{"halved",   "doubled",  "eroded",      "dilated",
                                                "measured", "as given", "strand field"};

/// What one way of reading makes of a scene.
struct Read {
  bool asked = false;
  double best_cm = kNothing_cm;     // of the hypothesis of highest score
  double nearest_cm = kNothing_cm;  // of the nearest of those that are taken
  double ms = 0;
};

struct Outcome {
  std::uint64_t index = 0;
  bool doubtful = false;
  std::array<Read, kWays> reads;
};

using Paths = flowdlo::Result<path::Traversals>;

Read read(const std::function<Paths()>& trace, const estimator::Conditions& conditions,
          const flowdlo::Frame& frame, const flowdlo::Centerline& truth) {
  Read result{.asked = true};
  const auto begin = std::chrono::steady_clock::now();
  const Paths paths = trace();
  if (paths) {
    const auto lifted = estimator::lift_all(*paths, conditions.cloud, conditions.visible, frame,
                                            flowdlo::weights::PriorKind::kRefined);
    const std::size_t count = lifted ? std::min(kOfEach, lifted->size()) : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double cm = 100 * flowdlo::eval::score((*lifted)[i].prior.nodes, truth).either_index_m;
      if (i == 0) result.best_cm = cm;
      result.nearest_cm = std::min(result.nearest_cm, cm);
    }
  }
  result.ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

flowdlo::Result<Outcome> measure(const flowdlo::strand::SceneRange& range, std::uint64_t index,
                                 field::Network& network) {
  const auto part = *synth::part_of(range.part);
  auto scene = synth::make_frame(synth::Split::kWide, part, 0, index, {.color = false});
  if (!scene) return scene.error();
  Outcome outcome{.index = index};
  flowdlo::Timings timings;
  const auto plain =
      estimator::gather(scene->frame(), 0, flowdlo::weights::PriorKind::kRefined, timings);
  if (!plain) return plain.error();
  const auto kinds = estimator::worth_reading(*plain, scene->frame());
  if (kinds.empty()) return outcome;
  outcome.doubtful = true;
  scene = synth::make_frame(synth::Split::kWide, part, 0, index, {.color = true});
  if (!scene) return scene.error();
  const flowdlo::Frame frame = scene->frame();
  const auto truth = scene->truth();
  const float width_px = plain->paths.rope_width_px;
  outcome.reads[kAsGiven] = read([&] { return path::trace(frame); }, *plain, frame, truth);
  for (std::size_t i = 0; i < kMaskReadings.size(); ++i) {
    if (std::find(kinds.begin(), kinds.end(), kMaskReadings[i]) == kinds.end()) continue;
    outcome.reads[i] = read([&] { return path::trace_as(kMaskReadings[i], frame, width_px); },
                            *plain, frame, truth);
  }
  const auto by_field = [&]() -> Paths {
    const auto seen = field::see(frame, width_px, network);
    if (!seen) return seen.error();
    return path::trace_strands(frame, field::axes(*seen));
  };
  outcome.reads[kField] = read(by_field, *plain, frame, truth);
  return outcome;
}

/// Mean of a list, and the share of it that is far off.
std::string mean_text(const std::vector<double>& errors_cm) {
  double sum = 0;
  double over = 0;
  for (const double cm : errors_cm) {
    sum += cm;
    over += cm > kFarOff_cm ? 1 : 0;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, errors_cm.size()));
  return fmt::format("{:.3f} / {:.1f}", sum / count, 100 * over / count);
}

/// [doubtful] of the nearest hypothesis of those ways that `use` lets in.
std::vector<double> nearest_cm(const std::vector<Outcome>& doubtful,
                               const std::function<bool(std::size_t)>& use) {
  std::vector<double> nearest_cm;
  for (const Outcome& outcome : doubtful) {
    double cm = kNothing_cm;
    for (std::size_t way = 0; way < kWays; ++way) {
      if (use(way)) cm = std::min(cm, outcome.reads[way].nearest_cm);
    }
    nearest_cm.push_back(cm);
  }
  return nearest_cm;
}

std::string nearest_text(const std::vector<Outcome>& doubtful,
                         const std::function<bool(std::size_t)>& use) {
  return mean_text(nearest_cm(doubtful, use));
}

/// One reading after the other, each time the one that helps most.
void report_selection(const std::vector<Outcome>& doubtful) {
  std::array<bool, kWays> used{};
  used[kAsGiven] = true;
  fmt::print("\nAs given {}", nearest_text(doubtful, [&](auto way) { return used[way]; }));
  for (std::size_t count = 1; count < kWays; ++count) {
    std::size_t best = kWays;
    double least_cm = 0;
    for (std::size_t next = 0; next < kWays; ++next) {
      if (used[next]) continue;
      const auto errors_cm =
          nearest_cm(doubtful, [&](auto way) { return used[way] || way == next; });
      const double sum_cm = std::accumulate(errors_cm.begin(), errors_cm.end(), 0.0);
      if (best < kWays && sum_cm >= least_cm) continue;
      best = next;
      least_cm = sum_cm;
    }
    used[best] = true;
    fmt::print(", and {} {}", kNames[best],
               nearest_text(doubtful, [&](auto way) { return used[way]; }));
  }
  fmt::print("\n");
}

void report(const std::vector<Outcome>& outcomes) {
  std::vector<Outcome> doubtful;
  std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(doubtful),
               [](const Outcome& outcome) { return outcome.doubtful; });
  fmt::print(
      "{} of {} scenes are doubtful; of these, index error in cm / share over 2 cm in %:\n"
      "| reading | scenes | its best hypothesis | nearest of all readings without it | nearest of "
      "it and the mask as given | ms of one core, median and 99 % |\n|---|---|---|---|---|---|\n",
      doubtful.size(), outcomes.size());
  for (std::size_t way = 0; way < kWays; ++way) {
    std::vector<double> best_cm;
    std::vector<double> ms;
    for (const Outcome& outcome : doubtful) {
      if (!outcome.reads[way].asked) continue;
      best_cm.push_back(outcome.reads[way].best_cm);
      ms.push_back(outcome.reads[way].ms);
    }
    if (ms.empty()) continue;
    std::sort(ms.begin(), ms.end());
    fmt::print("| {} | {} | {} | {} | {} | {:.0f}, {:.0f} |\n", kNames[way], ms.size(),
               mean_text(best_cm), nearest_text(doubtful, [&](auto w) { return w != way; }),
               nearest_text(doubtful, [&](auto w) { return w == way || w == kAsGiven; }),
               ms[ms.size() / 2], ms[ms.size() * 99 / 100]);
  }
  fmt::print("| all | {} | | {} | | |\n", doubtful.size(),
             nearest_text(doubtful, [](auto) { return true; }));
  report_selection(doubtful);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Which further readings of a doubtful mask are worth their time"};
  flowdlo::strand::SceneRange range;
  range.part = "training";
  range.first = 7000000;
  flowdlo::strand::add_options(app, range);
  CLI11_PARSE(app, argc, argv);
  const auto weights = flowdlo::strand::weights_of(range);
  if (!weights) return 1;
  const auto outcomes = flowdlo::strand::over_scenes<Outcome>(
      range, weights,
      [&](std::uint64_t index, field::Network& network) { return measure(range, index, network); });
  if (outcomes.empty()) return 1;
  report(outcomes);
  return 0;
}
