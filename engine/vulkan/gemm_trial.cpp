#include "vulkan/gemm_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vulkan/program.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kDraws = 4;
constexpr int kRuns = 3;
constexpr int kSamples = 97;  // entries of each result that are looked at
constexpr double kLargest = 1e-4;
constexpr double kLargestOfMatrix = 5e-3;  // x has the 11 bits of f16

/// Of [-1/2, 1/2), the same everywhere; f16 holds them exactly where `fine` is 1.
std::vector<float> numbers(int rows, int columns, std::uint32_t seed, float fine) {
  std::vector<float> values(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  std::uint32_t state = seed;
  for (float& value : values) {
    state = state * 1664525U + 1013904223U;
    value = (static_cast<float>(state >> 24U) / 256.0F - 0.5F) * fine;
  }
  return values;
}

struct Layer {
  int in;
  int out;
  ops::Activation activation;
  bool residual;
  float fine;  // other than 1: its weights are no f16
};

// As in the model: attention's projections, the feed-forward block, and a layer whose weights were
// multiplied by gamma.
constexpr std::array kLayers{Layer{256, 768, ops::Activation::kNone, false, 1.0F},
                             Layer{256, 1024, ops::Activation::kGelu, false, 1.0F},
                             Layer{1024, 256, ops::Activation::kNone, true, 1.0F},
                             Layer{256, 256, ops::Activation::kNone, true, 0.3F}};

/// One layer's operands and results on the host.
struct Recorded {
  std::vector<float> x;
  std::vector<float> weight;
  std::vector<float> bias;
  std::vector<float> residual;
  ops::Tensor y;
  ops::Tensor copied;
};

Recorded record(Program& program, const Layer& layer, int rows, std::uint32_t seed) {
  Recorded recorded{.x = numbers(rows, layer.in, seed, 1.0F),
                    .weight = numbers(layer.out, layer.in, seed + 1, layer.fine),
                    .bias = numbers(1, layer.out, seed + 2, 1.0F),
                    .residual = numbers(rows, layer.out, seed + 3, 1.0F),
                    .y = program.scratch("trial.y", rows, layer.out),
                    .copied = program.output("trial.result", rows, layer.out)};
  const auto x = program.constant("trial.x", rows, layer.in, recorded.x);
  ops::Linear op{
      .x = x,
      .layer = program.layer("trial", layer.out, layer.in, recorded.weight, recorded.bias),
      .y = recorded.y,
      .activation = layer.activation};
  if (layer.residual) {
    op.residual = program.constant("trial.residual", rows, layer.out, recorded.residual);
  }
  program.record(op);
  return recorded;
}

double expected_at(const Layer& layer, const Recorded& recorded, int row, int column) {
  double sum = static_cast<double>(recorded.bias[static_cast<std::size_t>(column)]);
  const float* const x = recorded.x.data() + static_cast<std::ptrdiff_t>(row) * layer.in;
  const float* const w = recorded.weight.data() + static_cast<std::ptrdiff_t>(column) * layer.in;
  for (int k = 0; k < layer.in; ++k) sum += static_cast<double>(x[k]) * static_cast<double>(w[k]);
  if (layer.activation == ops::Activation::kGelu) sum *= 0.5 * std::erfc(-sum * std::sqrt(0.5));
  if (layer.residual) {
    const auto entry = static_cast<std::size_t>(row) * static_cast<std::size_t>(layer.out);
    sum += static_cast<double>(recorded.residual[entry + static_cast<std::size_t>(column)]);
  }
  return sum;
}

/// Largest difference to double precision, of the largest entry; infinite where one is no number.
double difference(const Layer& layer, const Recorded& recorded, const std::vector<float>& got) {
  const int rows = recorded.y.rows;
  double largest = 0;
  double worst = 0;
  for (int sample = 0; sample < kSamples; ++sample) {
    const int row = sample * 131 % rows;
    const int column = sample * 389 % layer.out;
    const double expected = expected_at(layer, recorded, row, column);
    const auto entry = static_cast<std::size_t>(row) * static_cast<std::size_t>(layer.out);
    const double value = static_cast<double>(got[entry + static_cast<std::size_t>(column)]);
    if (!std::isfinite(value)) return HUGE_VAL;
    largest = std::max(largest, std::abs(expected));
    worst = std::max(worst, std::abs(expected - value));
  }
  return worst / largest;
}

}  // namespace

Result<double> try_gemm(const std::shared_ptr<Device>& device, const GemmChoice& choice,
                        const ProgramOptions& options) {
  const bool is_cpu = device->facts().report.kind == DeviceKind::kCpu;
  const int rows = (is_cpu ? 1 : kDraws) * ops::kRowsPerDraw;
  ProgramOptions forced;
  forced.timeout_ms = options.timeout_ms;
  forced.gemm = choice;
  Program program(device, forced);
  program.stage("gemm");
  std::vector<Recorded> recorded;
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    recorded.push_back(record(program, kLayers[i], rows, static_cast<std::uint32_t>(10 * i)));
  }
  program.stage("results");
  for (const Recorded& layer : recorded) {
    program.record(ops::Copy{.from = layer.y, .to = layer.copied});
  }
  if (const auto built = program.build(); !built) return built.error();
  double least_ms = 0;
  for (int run = 0; run < kRuns; ++run) {  // the first is slower, and others may want the machine
    if (const auto done = program.run(); !done) return done.error();
    const double ms = program.stage_times_ms().front().second;
    least_ms = run == 0 ? ms : std::min(least_ms, ms);
  }
  const double most = choice.family == GemmFamily::kMatrix ? kLargestOfMatrix : kLargest;
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    std::vector<float> got(static_cast<std::size_t>(rows) *
                           static_cast<std::size_t>(kLayers[i].out));
    program.read(recorded[i].copied, got);
    if (options.disturb) options.disturb(choice, got);
    const double off = difference(kLayers[i], recorded[i], got);
    if (off > most) {
      return Error{ErrorCode::kNoDevice,
                   fmt::format("{}: expected the layer [{}, {}] within {:.0e}, got {:.1e}",
                               name_of(choice), kLayers[i].out, kLayers[i].in, most, off)};
    }
  }
  return least_ms;
}

}  // namespace flowdlo::vulkan
