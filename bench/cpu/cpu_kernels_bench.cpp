// Kernels of the CPU back end on one thread, for every instruction set this processor has. Each
// result is first checked against plain sums in double precision; GFLOP/s stand beside the share of
// the multiply-add peak measured just before.
//
//   cpu_kernels_bench [Google Benchmark's options]
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "cpu/fma_peak.hpp"
#include "random/philox.hpp"
#include "reference/aligned_floats.hpp"
#include "reference/kernels.hpp"

namespace flowdlo::bench {
namespace {

using reference::AlignedFloats;
using reference::Kernels;

constexpr int kRows = 2 * ops::kRowsPerDraw;  // two draws: what a thread of two takes at once
constexpr int kCopies = 6;                    // of the weights, as six encoder layers go by

AlignedFloats noise(int count, std::uint64_t seed, float scale) {
  AlignedFloats values(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    values.data()[i] = scale * random::gaussian(seed, static_cast<std::uint64_t>(i) / 4)[i % 4];
  }
  return values;
}

double gelu(double x) { return 0.5 * x * (1 + std::erf(x / std::sqrt(2.0))); }

void report(benchmark::State& state, double flop, double peak_gflops) {
  state.counters["GFLOP/s"] = benchmark::Counter(
      flop * 1e-9, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
  if (peak_gflops > 0) {
    state.counters["%peak"] = benchmark::Counter(100 * flop * 1e-9 / peak_gflops,
                                                 benchmark::Counter::kIsIterationInvariantRate);
  }
}

void linear(benchmark::State& state, const Kernels& kernels, int in, int out, bool with_gelu) {
  const float scale = 1.0F / std::sqrt(static_cast<float>(in));
  const auto x = noise(kRows * in, 1, 1);
  const auto weight = noise(in * out, 2, scale);
  const auto bias = noise(out, 3, 1);
  const AlignedFloats y(static_cast<std::size_t>(kRows) * out);
  std::vector<AlignedFloats> panels;
  for (int i = 0; i < kCopies; ++i) {
    panels.emplace_back(weight.size());
    kernels.pack(weight.data(), out, in, panels.back().data());
  }
  reference::LinearBlock block{x.data(),
                               panels[0].data(),
                               bias.data(),
                               nullptr,
                               y.data(),
                               kRows,
                               in,
                               out,
                               0,
                               out,
                               with_gelu ? ops::Activation::kGelu : ops::Activation::kNone};
  kernels.linear(block);
  for (int i = 0; i < kRows * out; i += 37) {
    double sum = static_cast<double>(bias.data()[i % out]);
    for (int k = 0; k < in; ++k) {
      sum += static_cast<double>(x.data()[i / out * in + k]) *
             static_cast<double>(weight.data()[i % out * in + k]);
    }
    if (std::abs((with_gelu ? gelu(sum) : sum) - static_cast<double>(y.data()[i])) > 2e-5) {
      return state.SkipWithError("the result differs from the plain sum");
    }
  }
  const double peak = fma_peak_gflops(kernels.isa);
  std::size_t copy = 0;
  for (auto _ : state) {
    block.panels = panels[copy++ % panels.size()].data();
    kernels.linear(block);
  }
  report(state, 2.0 * kRows * in * out, peak);
}

void attention(benchmark::State& state, const Kernels& kernels, int keys) {
  constexpr int kStride = 3 * ops::kWidth;
  const auto rows = noise(keys * kStride, 1, 1);
  const AlignedFloats out(static_cast<std::size_t>(ops::kRowsPerDraw) * ops::kHeadWidth);
  const reference::AttentionBlock block{rows.data(),
                                        rows.data() + ops::kWidth,
                                        rows.data() + 2 * ops::kWidth,
                                        nullptr,
                                        out.data(),
                                        kStride,
                                        kStride,
                                        ops::kHeadWidth,
                                        keys};
  kernels.attention(block);
  for (int query = 0; query < ops::kRowsPerDraw; query += 13) {
    double total = 0;
    double mixed = 0;
    for (int key = 0; key < keys; ++key) {
      double dot = 0;
      for (int i = 0; i < ops::kHeadWidth; ++i) {
        dot += static_cast<double>(block.query[query * kStride + i]) *
               static_cast<double>(block.key[key * kStride + i]);
      }
      total += std::exp(dot / std::sqrt(32.0));
      mixed += std::exp(dot / std::sqrt(32.0)) * static_cast<double>(block.value[key * kStride]);
    }
    if (std::abs(mixed / total - static_cast<double>(out.data()[query * ops::kHeadWidth])) > 1e-5) {
      return state.SkipWithError("the result differs from the plain sum");
    }
  }
  const double peak = fma_peak_gflops(kernels.isa);
  for (auto _ : state) kernels.attention(block);
  report(state, 4.0 * ops::kRowsPerDraw * keys * ops::kHeadWidth, peak);
}

void layer_norm(benchmark::State& state, const Kernels& kernels) {
  const auto x = noise(kRows * ops::kWidth, 1, 1);
  const auto gain = noise(ops::kWidth, 2, 1);
  const auto shift = noise(ops::kWidth, 3, 1);
  const AlignedFloats y(x.size());
  const reference::LayerNormBlock block{x.data(), gain.data(), shift.data(), y.data(), kRows};
  kernels.layer_norm(block);
  double mean = 0;
  double square = 0;
  for (int i = 0; i < ops::kWidth; ++i) {
    const double value = static_cast<double>(x.data()[i]);
    mean += value / ops::kWidth;
    square += value * value / ops::kWidth;
  }
  const double expected = (static_cast<double>(x.data()[5]) - mean) /
                              std::sqrt(square - mean * mean + 1e-5) *
                              static_cast<double>(gain.data()[5]) +
                          static_cast<double>(shift.data()[5]);
  if (std::abs(expected - static_cast<double>(y.data()[5])) > 1e-5) {
    return state.SkipWithError("the result differs from the plain sum");
  }
  for (auto _ : state) kernels.layer_norm(block);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * 2 *
                          static_cast<std::int64_t>(x.size() * sizeof(float)));
}

void register_all() {
  for (const Kernels& kernels : reference::kernels_of_this_cpu()) {
    const auto add = [&](const std::string& name, std::function<void(benchmark::State&)> run) {
      benchmark::RegisterBenchmark((std::string(kernels.isa) + "/" + name).c_str(), std::move(run))
          ->MinTime(0.2);
    };
    const auto add_linear = [&](int in, int out, bool with_gelu) {
      add("linear/" + std::to_string(kRows) + "x" + std::to_string(in) + "x" + std::to_string(out) +
              (with_gelu ? "/gelu" : ""),
          [=](benchmark::State& state) { linear(state, kernels, in, out, with_gelu); });
    };
    add_linear(256, 256, false);
    add_linear(256, 768, false);
    add_linear(256, 1024, true);
    add_linear(1024, 256, false);
    for (const int keys : {64, 256}) {
      add("attention/" + std::to_string(keys) + "_keys",
          [=](benchmark::State& state) { attention(state, kernels, keys); });
    }
    add("layer_norm", [=](benchmark::State& state) { layer_norm(state, kernels); });
  }
}

}  // namespace
}  // namespace flowdlo::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto& kernels : flowdlo::reference::kernels_of_this_cpu()) {
    std::printf("%s: multiply-add peak of one core %.0f GFLOP/s\n", kernels.isa,
                flowdlo::bench::fma_peak_gflops(kernels.isa));
  }
  flowdlo::bench::register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
