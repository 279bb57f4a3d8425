#include "link_fit/fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "gate_fit/network_fit.hpp"
#include "link_fit/choices.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::size_t kBatch = 290;  // scenes of a batch, about
constexpr double kRate = 0.008;      // of the descent
constexpr double kRidge = 2e-7;      // penalty of squared weights
constexpr double kByItself =
    0.1;  // how much each link and stop by itself weighs beside the choices

/// Rows of a sample: one of each end, then both ways of each link.
std::size_t rows_of(const LinkSample& sample) {
  return sample.ends.size() + 2 * sample.links.size();
}

/// What each thing of the sample says, from what its rows say.
std::vector<double> against_of(const LinkSample& sample, std::span<const double> said) {
  const std::size_t ends = sample.ends.size();
  std::vector<double> against(said.begin(), said.begin() + static_cast<std::ptrdiff_t>(ends));
  for (std::size_t i = 0; i < sample.links.size(); ++i) {
    against.push_back(0.5 * (said[ends + 2 * i] + said[ends + 2 * i + 1]));
  }
  return against;
}

double energy_of(double against) {
  return std::max(against, 0.0) + std::log1p(std::exp(-std::abs(against)));
}
double likely_of(double odds) { return 1 / (1 + std::exp(-odds)); }

/// A sample with what may happen in it.
struct Known {
  const LinkSample* sample = nullptr;
  std::vector<EndChoice> choices;
  Truths truths;
};

/// What the sample's loss rises by with what each of its rows says.
void add_slopes(const Known& known, std::span<const double> said, std::span<double> slope) {
  const LinkSample& sample = *known.sample;
  const std::vector<double> against = against_of(sample, said);
  std::vector<double> costs;
  for (const double odds : against) costs.push_back(energy_of(odds));
  std::vector<double> slopes(costs.size(), 0);
  for (const EndChoice& choice : known.choices) (void)judge(choice, costs, slopes);
  const std::size_t ends = sample.ends.size();
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double unlikely = likely_of(against[i]);  // what the energy rises by as well
    const double wrong = unlikely - (known.truths.there[i] ? 0 : 1);
    const double total = slopes[i] * unlikely + (known.truths.known[i] ? kByItself * wrong : 0);
    if (i < ends) {
      slope[i] = total;
    } else {
      const std::size_t row = ends + 2 * (i - ends);
      slope[row] = slope[row + 1] = 0.5 * total;
    }
  }
}

}  // namespace

weights::LinkWeights fit_links(const std::vector<LinkSample>& samples, int rounds) {
  NetworkTask task{.inputs = path::kLinkFeatures,
                   .outputs = 1,
                   .hidden = static_cast<std::size_t>(weights::kLinkHidden),
                   .start = {0},
                   .ridge = kRidge,
                   .rate = kRate};
  std::vector<std::vector<Known>> batches((samples.size() + kBatch - 1) / kBatch);
  for (std::size_t b = 0; b < batches.size(); ++b) {
    std::size_t rows = 0;
    for (std::size_t s = b; s < samples.size(); s += batches.size()) {
      const LinkSample& sample = samples[s];
      batches[b].push_back({&sample, choices_of(sample), truths_of(sample)});
      rows += rows_of(sample);
      const auto add = [&](const path::LinkFeatures& features) {
        task.rows.insert(task.rows.end(), features.begin(), features.end());
      };
      for (const auto& end : sample.ends) add(end.features);
      for (const auto& link : sample.links) {
        add(link.forth);
        add(link.back);
      }
    }
    task.batches.push_back(rows);
  }
  task.steps = rounds * static_cast<int>(batches.size());
  task.slopes = [&](std::size_t batch, std::span<const double> said, std::span<double> slope) {
    std::size_t first = 0;
    for (const Known& known : batches[batch]) {
      const std::size_t rows = rows_of(*known.sample);
      add_slopes(known, said.subspan(first, rows), slope.subspan(first, rows));
      first += rows;
    }
  };
  return section_of(fit_network(task), weights::links_manifest());
}

LinkQuality quality_of(std::span<const LinkSample> samples, const weights::LinkWeights* weights) {
  LinkQuality quality;
  std::optional<path::LinkNetwork> network;
  if (weights != nullptr) network.emplace(*weights);
  for (const LinkSample& sample : samples) {
    std::vector<double> costs;
    for (const auto& end : sample.ends) {
      costs.push_back(static_cast<double>(network ? network->energy(end.features) : end.by_energy));
    }
    for (const auto& link : sample.links) {
      costs.push_back(
          static_cast<double>(network ? network->energy(link.forth, link.back) : link.by_energy));
    }
    for (const EndChoice& choice : choices_of(sample)) {
      const Judged judged = judge(choice, costs, {});
      ++quality.choices;
      quality.unlikely += judged.unlikely;
      quality.wrong += judged.right ? 0 : 1;
    }
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, quality.choices));
  quality.unlikely /= count;
  quality.wrong /= count;
  return quality;
}

}  // namespace flowdlo::lab
