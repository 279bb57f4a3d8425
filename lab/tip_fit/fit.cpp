#include "tip_fit/fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "gate_fit/network_fit.hpp"
#include "survey/values.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::size_t kBatch = 512;  // ends of a batch, about
constexpr double kRate = 0.002;      // of the descent
constexpr double kRidge = 2e-4;      // penalty of squared weights
constexpr double kCorner = 0.02;     // of what is said: a distance is smooth within that

/// As far as the network may say.
double within(float widths) {
  return static_cast<double>(std::clamp(widths, -refine::kMostBefore, refine::kMostBeyond));
}

/// What a network of tips should say of it.
double wanted(const TipSample& sample) {
  return std::asinh(within(sample.beyond_widths) / static_cast<double>(refine::kTipUnit));
}

}  // namespace

weights::TipWeights fit_tips(const std::vector<TipSample>& samples, int rounds) {
  const std::size_t count = std::max<std::size_t>(1, samples.size() / kBatch);
  std::vector<std::vector<const TipSample*>> batches(count);
  for (std::size_t i = 0; i < samples.size(); ++i) batches[i % count].push_back(&samples[i]);
  NetworkTask task{.inputs = refine::kTipFeatures,
                   .outputs = 1,
                   .hidden = static_cast<std::size_t>(weights::kTipHidden),
                   .start = {0},
                   .ridge = kRidge,
                   .steps = rounds * static_cast<int>(count),
                   .rate = kRate};
  for (const auto& batch : batches) {
    task.batches.push_back(batch.size());
    for (const TipSample* sample : batch) {
      task.rows.insert(task.rows.end(), sample->features.begin(), sample->features.end());
    }
  }
  task.slopes = [&](std::size_t batch, std::span<const double> said, std::span<double> slope) {
    for (std::size_t i = 0; i < said.size(); ++i) {
      const double off = said[i] - wanted(*batches[batch][i]);
      slope[i] = off / std::hypot(off, kCorner);
    }
  };
  return section_of(fit_network(task), weights::tips_manifest());
}

TipQuality quality_of(std::span<const TipSample> samples, const weights::TipWeights* weights) {
  std::optional<refine::TipNetwork> network;
  if (weights != nullptr) network.emplace(*weights);
  survey::Values off;
  for (const TipSample& sample : samples) {
    const double said = network ? static_cast<double>(network->beyond(sample.features)) : 0;
    off.add(std::abs(within(sample.beyond_widths) - said));
  }
  return {samples.size(), off.mean(), off.median()};
}

}  // namespace flowdlo::lab
