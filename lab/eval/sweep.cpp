#include "eval/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/interval.hpp"
#include "eval/metrics.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "survey/values.hpp"

namespace flowdlo::eval {
namespace {

constexpr double kCm = 100;
constexpr double kNothing = 1.01;  // a ratio of means up to here is no loss
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<Setting> pairs(std::span<const int> steps, std::span<const int> draws) {
  const Config full;
  std::vector<Setting> settings{{full.euler_steps, full.draws, {}, {}, {}}};
  for (const int k : steps) {
    for (const int d : draws) {
      if (k != full.euler_steps || d != full.draws) settings.push_back({k, d, {}, {}, {}});
    }
  }
  return settings;
}

/// Mean index error of the draws.
double of_draws(const Tensors& tensors, const Centerline& truth) {
  double sum = 0;
  for (int draw = 0; draw < tensors.draws; ++draw) {
    Centerline nodes{};
    const float* from = tensors.prediction.data() + static_cast<std::size_t>(draw) * kNodes * 3;
    for (std::size_t i = 0; i < kNodes; ++i) {
      nodes[i] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
    }
    sum += score(nodes, truth).index_m / tensors.draws;
  }
  return sum;
}

void run(Estimator& estimator, const std::filesystem::path& path, Setting& setting) {
  const auto folder = load_frame_folder(path);
  const bool usable = folder && folder->truth.has_value();
  Tensors tensors;
  const auto estimate = usable ? estimator.estimate(folder->frame(), tensors)
                               : Result<Estimate>(Error{ErrorCode::kBadInput, ""});
  setting.model_m.push_back(estimate ? of_draws(tensors, *folder->truth) : kNone);
  setting.estimate_m.push_back(estimate ? score(estimate->nodes, *folder->truth).index_m : kNone);
  setting.model_ms.push_back(estimate ? estimate->timings.model_ms : kNone);
}

/// Only frames in which every setting gave something can be compared.
void keep_common(std::vector<Setting>& settings) {
  const std::size_t frames = settings.front().model_m.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const bool common = std::none_of(settings.begin(), settings.end(), [&](const Setting& setting) {
      return std::isnan(setting.model_m[i]);
    });
    if (!common) continue;
    for (Setting& setting : settings) {
      for (auto* values : {&setting.model_m, &setting.estimate_m, &setting.model_ms}) {
        (*values)[kept] = (*values)[i];
      }
    }
    ++kept;
  }
  for (Setting& setting : settings) {
    for (auto* values : {&setting.model_m, &setting.estimate_m, &setting.model_ms}) {
      values->resize(kept);
    }
  }
}

}  // namespace

std::size_t settings_of(std::span<const int> steps, std::span<const int> draws) {
  return pairs(steps, draws).size();
}

Result<std::vector<Setting>> sweep(const Config& config,
                                   std::span<const std::filesystem::path> frames,
                                   std::span<const int> steps, std::span<const int> draws,
                                   const std::function<void()>& advance) {
  auto settings = pairs(steps, draws);
  for (Setting& setting : settings) {
    Config one = config;
    one.quality = Quality::kFull;
    one.euler_steps = setting.steps;
    one.draws = setting.draws;
    auto estimator = Estimator::create(one);
    if (!estimator) return estimator.error();
    for (const auto& frame : frames) {
      run(*estimator, frame, setting);
      advance();
    }
  }
  keep_common(settings);
  return settings;
}

std::size_t cheapest(std::span<const Setting> settings) {
  const Setting& full = settings.front();
  std::size_t best = 0;
  for (std::size_t i = 1; i < settings.size(); ++i) {
    const Setting& setting = settings[i];
    if (setting.evaluations() >= settings[best].evaluations() || setting.model_m.empty()) continue;
    const double model = ratio_interval(setting.model_m, full.model_m).high;
    const double estimate = ratio_interval(setting.estimate_m, full.estimate_m).high;
    if (model <= kNothing && estimate <= kNothing) best = i;
  }
  return best;
}

std::string sweep_markdown(std::span<const Setting> settings) {
  const Setting& full = settings.front();
  std::string out = fmt::format(
      "## Error against K and D\n\nMean index error (Eq. 4.1) over {} frames, cm; in brackets its "
      "ratio to that of K = {}, D = {} with the 95 % bootstrap interval, in pairs.\n\n"
      "| K | D | model, every draw | estimate | model's part, median ms |\n|---|---|---|---|---|\n",
      full.model_m.size(), full.steps, full.draws);
  for (const Setting& setting : settings) {
    out += fmt::format("| {} | {} |", setting.steps, setting.draws);
    for (const auto values : {&Setting::model_m, &Setting::estimate_m}) {
      const Interval ratio = ratio_interval(setting.*values, full.*values);
      out += fmt::format(" {:.3f} ({:.3f} [{:.3f}, {:.3f}]) |",
                         kCm * survey::Values(setting.*values).mean(), ratio.value, ratio.low,
                         ratio.high);
    }
    out += fmt::format(" {:.1f} |\n", survey::Values(setting.model_ms).median());
  }
  const Setting& best = settings[cheapest(settings)];
  return out + fmt::format(
                   "\nCheapest that loses nothing (upper end of both intervals at most {:.2f}): "
                   "K = {}, D = {}.\n"
                   "flowdlo weights set-fast FILE OUT --steps {} --draws {}\n",
                   kNothing, best.steps, best.draws, best.steps, best.draws);
}

}  // namespace flowdlo::eval
