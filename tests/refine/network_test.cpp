#include "refine/network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/program.hpp"
#ifdef FLOWDLO_WITH_VULKAN
#include "vulkan/backend.hpp"
#endif

namespace flowdlo::refine {
namespace {

Strip random_strip() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1, 1);
  Strip strip;
  for (int i = 0; i < kStations * weights::kRefineInputs; ++i) {
    strip.values.push_back(value(random));
  }
  return strip;
}

std::array<Offset, kNodes> seen(const weights::RefineWeights& weights,
                                const ProgramFactory& make_program) {
  auto network = Network::create(weights, make_program);
  if (!network) throw std::runtime_error(network.error().message);
  const auto offsets = network->see(random_strip());
  if (!offsets) throw std::runtime_error(offsets.error().message);
  return *offsets;
}

// -- The network once more, plainly, in double ----------------------------------------------------

/// [station of the node][node][channel]
using Plain = std::vector<std::vector<std::vector<double>>>;

Plain convolved(const weights::RefineWeights& weights, const std::string& name, const Plain& x,
                bool relu) {
  const auto& weight = weights.at(name + ".weight");
  const auto& bias = weights.at(name + ".bias");
  const int taps = weight.shape[1];
  const int in = weight.shape[2];
  Plain y(kStationsOfNode, std::vector<std::vector<double>>(kNodes));
  for (int sub = 0; sub < kStationsOfNode; ++sub) {
    for (int node = 0; node < static_cast<int>(kNodes); ++node) {
      for (int out = 0; out < weight.shape[0]; ++out) {
        double sum = static_cast<double>(bias.values[static_cast<std::size_t>(out)]);
        for (int tap = 0; tap < taps; ++tap) {
          const int s = sub + (taps == 1 ? 0 : tap / 3 - 1);
          const int n = node + (taps == 1 ? 0 : tap % 3 - 1);
          if (s < 0 || n < 0 || s >= kStationsOfNode || n >= static_cast<int>(kNodes)) continue;
          for (int i = 0; i < in; ++i) {
            sum += x[static_cast<std::size_t>(s)][static_cast<std::size_t>(n)]
                    [static_cast<std::size_t>(i)] *
                   static_cast<double>(
                       weight.values[static_cast<std::size_t>((out * taps + tap) * in + i)]);
          }
        }
        y[static_cast<std::size_t>(sub)][static_cast<std::size_t>(node)].push_back(
            relu ? std::max(0.0, sum) : sum);
      }
    }
  }
  return y;
}

TEST(RefineNetwork, IsWhatItsLayersSay) {
  const auto weights = weights::seeded_refine(7);
  const Strip strip = random_strip();
  Plain x(kStationsOfNode, std::vector<std::vector<double>>(kNodes));
  for (std::size_t j = 0; j < kStations; ++j) {
    auto& place = x[j % kStationsOfNode][j / kStationsOfNode];
    for (std::size_t c = 0; c < weights::kRefineInputs; ++c) {
      place.push_back(static_cast<double>(strip.values[j * weights::kRefineInputs + c]));
    }
  }
  x = convolved(weights, "stem", x, true);
  for (int i = 0; i < weights::kRefineSquares; ++i) {
    x = convolved(weights, "square." + std::to_string(i), x, true);
  }
  x = convolved(weights, "head", x, false);
  const auto offsets = seen(weights, [] { return reference::create_program(1); });
  std::array<std::array<double, 3>, kNodes> said{};
  for (std::size_t node = 0; node < kNodes; ++node) {
    for (std::size_t sub = 0; sub < kStationsOfNode; ++sub) {
      for (std::size_t k = 0; k < 3; ++k) said[node][k] += x[sub][node][k] / kStationsOfNode;
    }
  }
  double largest = 0;
  for (int node = 0; node < static_cast<int>(kNodes); ++node) {
    const auto& [deep, aside, own] = said[static_cast<std::size_t>(node)];
    double log_odds = 0;
    int beside = 0;
    for (int k = node - weights::kRefineAlike; k <= node + weights::kRefineAlike; ++k) {
      if (k < 0 || k >= static_cast<int>(kNodes)) continue;
      log_odds += said[static_cast<std::size_t>(k)][2];
      ++beside;
    }
    const Offset& offset = offsets[static_cast<std::size_t>(node)];
    EXPECT_NEAR(static_cast<double>(offset.deep), deep, 1e-4);
    EXPECT_NEAR(static_cast<double>(offset.aside), aside, 1e-4);
    EXPECT_NEAR(static_cast<double>(offset.laid), 1 / (1 + std::exp(-log_odds / beside)), 1e-4);
    largest = std::max({largest, std::abs(deep), std::abs(aside), std::abs(own)});
  }
  EXPECT_GT(largest, 0.1);  // noise says something, so that the comparison does
}

#ifdef FLOWDLO_WITH_VULKAN
TEST(RefineNetwork, VulkanSaysWhatTheCpuSays) {
  const auto weights = weights::seeded_refine(7);
  const auto cpu = seen(weights, [] { return reference::create_program(1); });
  int compared = 0;
  for (const auto& report : vulkan::survey().devices) {
    if (!report.lacks.empty()) continue;
    const auto device = vulkan::open_device({.wanted = report.uuid});
    if (!device) continue;
    SCOPED_TRACE(report.name);
    const auto gpu = seen(weights, [&] {
      return vulkan::create_program(*device, {.timeout_ms = 60000, .pipeline_cache = {}});
    });
    for (std::size_t node = 0; node < kNodes; ++node) {
      EXPECT_NEAR(gpu[node].deep, cpu[node].deep, 1e-4F);
      EXPECT_NEAR(gpu[node].aside, cpu[node].aside, 1e-4F);
      EXPECT_NEAR(gpu[node].laid, cpu[node].laid, 1e-4F);
    }
    ++compared;
  }
  if (compared == 0) GTEST_SKIP() << "no Vulkan device";
}
#endif

}  // namespace
}  // namespace flowdlo::refine
