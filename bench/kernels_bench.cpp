// Kernels on a Vulkan device: each result is checked against the CPU back end, then timed by the
// device's clock, less the cost of an empty dispatch.
//
//   kernels_bench [--device=NAME] [--gemm=ROWSxCOLUMNSxDEPTH] [Google Benchmark's options]
//
// --gemm: the tile of CPU drivers' kernel for dense layers, in place of what the device is given.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "device_option.hpp"
#include "ops/program.hpp"
#include "random/philox.hpp"
#include "reference/program.hpp"
#include "vulkan/backend.hpp"
#include "weights/half.hpp"

namespace flowdlo {
namespace {

constexpr int kRepeats = 5;        // of the operation in one submission
constexpr int kRows = 256;         // four draws
constexpr float kLargest = 1e-4F;  // difference to the CPU, of the largest entry

std::vector<float> noise(int rows, int columns, std::uint64_t seed, float scale = 1.0F) {
  std::vector<float> values(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = scale * random::gaussian(seed, i / 4)[i % 4];
  }
  return values;
}

/// As the weights of a file: each value a half.
std::vector<float> halves(std::vector<float> values) {
  for (float& value : values) {
    value = weights::half_to_float(weights::float_to_half(value));
  }
  return values;
}

/// One operation, recorded some number of times between two stages.
struct Subject {
  int out_rows;
  int out_columns;
  /// Declares tensors, records the operation `repeats` times; inputs are constants.
  std::function<void(ops::Program&, ops::Tensor out, int repeats)> record;
  int repeats = kRepeats;
};

std::vector<float> result_of(ops::Program& program, const Subject& subject) {
  const auto out = program.output("out", subject.out_rows, subject.out_columns);
  subject.record(program, out, 1);
  std::vector<float> values(static_cast<std::size_t>(subject.out_rows) *
                            static_cast<std::size_t>(subject.out_columns));
  if (program.build() && program.run()) program.read(out, values);
  return values;
}

/// What --gemm asks for; none: what the device is given.
std::optional<vulkan::GemmChoice> wanted_gemm;

std::unique_ptr<ops::Program> program_on(const std::shared_ptr<vulkan::Device>& device) {
  vulkan::ProgramOptions options;
  options.gemm = wanted_gemm;
  return vulkan::create_program(device, options);
}

bool agrees(const std::shared_ptr<vulkan::Device>& device, const Subject& subject) {
  const auto cpu = reference::create_program(1);
  const auto gpu = program_on(device);
  const std::vector<float> expected = result_of(*cpu, subject);
  const std::vector<float> got = result_of(*gpu, subject);
  float largest = 0;
  float worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    largest = std::max(largest, std::abs(expected[i]));
    worst = std::max(worst, std::abs(expected[i] - got[i]));
  }
  return largest > 0 && worst <= kLargest * largest;
}

std::unique_ptr<ops::Program> timed_program(const std::shared_ptr<vulkan::Device>& device,
                                            const Subject& subject) {
  auto program = program_on(device);
  const auto out = program->output("out", subject.out_rows, subject.out_columns);
  program->stage("timed");
  subject.record(*program, out, subject.repeats);
  const auto built = program->build();
  if (!built) std::fprintf(stderr, "%s\n", built.error().message.c_str());
  return built ? std::move(program) : nullptr;
}

/// Seconds of one operation, by the device's clock.
double seconds_of(ops::Program& program, int repeats) {
  if (!program.run()) return 0;
  return program.stage_times_ms().back().second * 1e-3 / repeats;
}

/// Milliseconds that the CPU back end takes on one thread for the same: what CPU drivers are held
/// against.
double cpu_ms(const Subject& subject) {
  const auto program = reference::create_program(1);
  const auto out = program->output("out", subject.out_rows, subject.out_columns);
  program->stage("timed");
  subject.record(*program, out, subject.repeats);
  if (!program->build()) return 0;
  double best_s = std::numeric_limits<double>::max();
  for (int i = 0; i < 10; ++i) best_s = std::min(best_s, seconds_of(*program, subject.repeats));
  return best_s * 1e3;
}

/// The smallest dispatch there is: one row of Denormalize, and the barrier before it.
Subject empty_dispatch() {
  return {1, 4, [](ops::Program& program, ops::Tensor out, int repeats) {
            const auto norm = program.constant("norm", 1, 4, std::vector<float>{0, 0, 0, 1});
            const auto in = program.constant("in", 1, 4, std::vector<float>{1, 2, 3, 4});
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::Denormalize{.state = in, .norm = norm, .out = out});
            }
          }};
}

void run(benchmark::State& state, const std::shared_ptr<vulkan::Device>& device,
         const Subject& subject, double flop, bool beside_cpu) {
  if (!agrees(device, subject)) {
    state.SkipWithError("the result differs from the CPU's");
    return;
  }
  const auto empty = timed_program(device, empty_dispatch());
  const auto program = timed_program(device, subject);
  if (!empty || !program) {
    state.SkipWithError("the program does not build");
    return;
  }
  double floor_s = seconds_of(*empty, kRepeats);
  for (int i = 0; i < 10; ++i) floor_s = std::min(floor_s, seconds_of(*empty, kRepeats));
  double total_s = 0;
  double best_s = std::numeric_limits<double>::max();
  for (auto _ : state) {
    const double seconds = std::max(seconds_of(*program, subject.repeats) - floor_s, 1e-9);
    state.SetIterationTime(seconds);
    total_s += seconds;
    best_s = std::min(best_s, seconds);
  }
  const double each_s = total_s / static_cast<double>(state.iterations());
  state.counters["ms"] = each_s * 1e3;
  state.counters["best_ms"] = best_s * 1e3;  // what a busy machine does not disturb
  if (flop > 0) {
    state.counters["GFLOP/s"] = flop / each_s * 1e-9;
    state.counters["best_GFLOP/s"] = flop / best_s * 1e-9;
  }
  if (beside_cpu) state.counters["cpu_best_ms"] = cpu_ms(subject);
}

Subject gemm(int depth, int columns, ops::Activation activation = ops::Activation::kNone) {
  return {kRows, columns, [=](ops::Program& program, ops::Tensor out, int repeats) {
            const float scale = 1.0F / std::sqrt(static_cast<float>(depth));
            const auto x = program.constant("x", kRows, depth, noise(kRows, depth, 1));
            const auto layer =
                program.layer("layer", columns, depth, halves(noise(columns, depth, 2, scale)),
                              noise(1, columns, 3));
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::Linear{
                  .x = x, .layer = layer, .y = out, .activation = activation, .residual = {}});
            }
          }};
}

Subject self_attention() {
  return {kRows, 256, [](ops::Program& program, ops::Tensor out, int repeats) {
            const auto qkv = program.constant("qkv", kRows, 768, noise(kRows, 768, 1));
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::Attention{.query = qkv,
                                            .query_column = 0,
                                            .key_value = qkv,
                                            .key_column = 256,
                                            .value_column = 512,
                                            .per_draw = true,
                                            .key_valid = {},
                                            .out = out});
            }
          }};
}

Subject cross_attention() {
  return {kRows, 256, [](ops::Program& program, ops::Tensor out, int repeats) {
            const auto query = program.constant("query", kRows, 256, noise(kRows, 256, 1));
            const auto key_value = program.constant("keys", 256, 512, noise(256, 512, 2));
            std::vector<float> points(256 * 4, 1.0F);
            const auto valid = program.constant("valid", 256, 4, points);
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::Attention{.query = query,
                                            .query_column = 0,
                                            .key_value = key_value,
                                            .key_column = 0,
                                            .value_column = 256,
                                            .per_draw = false,
                                            .key_valid = valid,
                                            .out = out});
            }
          }};
}

Subject layer_norm() {
  return {kRows, 256, [](ops::Program& program, ops::Tensor out, int repeats) {
            const auto x = program.constant("x", kRows, 256, noise(kRows, 256, 1));
            const auto gain = program.constant("gain", 1, 256, noise(1, 256, 2));
            const auto shift = program.constant("shift", 1, 256, noise(1, 256, 3));
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::LayerNorm{.x = x, .gain = gain, .shift = shift, .y = out});
            }
          }};
}

Subject farthest_points(int count) {
  return {256, 4,
          [=](ops::Program& program, ops::Tensor out, int /*once*/) {
            const auto cloud = program.constant("cloud", count, 4, noise(count, 4, 1, 0.1F));
            std::vector<float> values(16, 0.0F);
            values[8] = static_cast<float>(count);  // FrameParams::point_count
            const auto params = program.constant("params", 1, 16, values);
            program.record(ops::FarthestPoints{.cloud = cloud, .params = params, .visible = out});
          },
          1};
}

/// The map of a square image, all of whose blocks are in use, row by row.
std::vector<float> full_map(int blocks_a_side) {
  std::vector<float> map;
  for (int block = 0; block < blocks_a_side * blocks_a_side; ++block) {
    for (int entry = 0; entry < 9; ++entry) {
      const int row = block / blocks_a_side + entry / 3 - 1;
      const int column = block % blocks_a_side + entry % 3 - 1;
      const bool inside = std::min(row, column) >= 0 && std::max(row, column) < blocks_a_side;
      map.push_back(inside ? static_cast<float>(row * blocks_a_side + column) : -1.0F);
    }
    map.insert(map.end(), 3, 0.0F);
  }
  return map;
}

constexpr int kBlocksASide = 10;
constexpr int kBlocks = kBlocksASide * kBlocksASide;

Subject convolution(int side, int in, int out, int taps) {
  const int places = kBlocks * side * side;
  return {places, out, [=](ops::Program& program, ops::Tensor y, int repeats) {
            const float scale = 1.0F / std::sqrt(static_cast<float>(taps * in));
            const auto x = program.constant("x", places, in, noise(places, in, 1));
            const auto map = program.constant("map", kBlocks, 12, full_map(kBlocksASide));
            const auto layer = program.convolution(
                "layer", out, taps, in, noise(out, taps * in, 2, scale), noise(1, out, 3));
            for (int i = 0; i < repeats; ++i) {
              program.record(
                  ops::Convolution{.x = x, .map = map, .layer = layer, .y = y, .side = side});
            }
          }};
}

double flop_of_convolution(int side, int in, int out, int taps) {
  return 2.0 * kBlocks * side * side * in * out * taps;
}

Subject max_pool(int side, int channels) {
  const int places = kBlocks * side * side;
  return {places / 4, channels, [=](ops::Program& program, ops::Tensor y, int repeats) {
            const auto x = program.constant("x", places, channels, noise(places, channels, 1));
            const auto map = program.constant("map", kBlocks, 12, full_map(kBlocksASide));
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::MaxPool{.x = x, .map = map, .y = y, .side = side});
            }
          }};
}

Subject add_upsampled(int side, int channels) {
  const int places = kBlocks * side * side;
  return {places, channels, [=](ops::Program& program, ops::Tensor y, int repeats) {
            const auto x =
                program.constant("x", places / 4, channels, noise(places / 4, channels, 1));
            const auto map = program.constant("map", kBlocks, 12, full_map(kBlocksASide));
            // What a device's first run, of build(), has added must not count.
            const auto zeros =
                program.constant("zeros", places, channels,
                                 std::vector<float>(static_cast<std::size_t>(places) * channels));
            program.record(ops::Copy{.from = zeros, .to = y});
            for (int i = 0; i < repeats; ++i) {
              program.record(ops::AddUpsampled{.x = x, .map = map, .y = y, .side = side});
            }
          }};
}

void register_all(const std::shared_ptr<vulkan::Device>& device) {
  const auto add = [&](const std::string& name, const Subject& subject, double flop,
                       bool beside_cpu = false) {
    benchmark::RegisterBenchmark(
        name.c_str(),
        [=](benchmark::State& state) { run(state, device, subject, flop, beside_cpu); })
        ->MeasureProcessCPUTime()
        ->UseManualTime()
        ->MinTime(0.2);
  };
  for (const int columns : {256, 512, 768, 1024}) {
    add("gemm/256x256x" + std::to_string(columns), gemm(256, columns), 2.0 * kRows * 256 * columns);
  }
  add("gemm+gelu/256x256x1024", gemm(256, 1024, ops::Activation::kGelu), 2.0 * kRows * 256 * 1024);
  add("gemm/256x1024x256", gemm(1024, 256), 2.0 * kRows * 1024 * 256);
  add("attention/self", self_attention(), 2.0 * 2 * kRows * 64 * 256);
  add("attention/cross", cross_attention(), 2.0 * 2 * kRows * 256 * 256);
  add("layer_norm", layer_norm(), 0);
  add("farthest_points/20000", farthest_points(20000), 0);
  add("farthest_points/300000", farthest_points(300000), 0);
  for (const auto& [side, in, out, taps] :
       {std::array{16, 32, 32, 9}, std::array{16, 48, 32, 9}, std::array{8, 48, 48, 9},
        std::array{4, 96, 96, 9}, std::array{8, 48, 32, 1}, std::array{16, 32, 16, 1}}) {
    add("convolution/" + std::to_string(side) + "/" + std::to_string(in) + "x" +
            std::to_string(out) + "x" + std::to_string(taps),
        convolution(side, in, out, taps), flop_of_convolution(side, in, out, taps), true);
  }
  add("max_pool/16/32", max_pool(16, 32), 0, true);
  add("add_upsampled/16/32", add_upsampled(16, 32), 0, true);
}

}  // namespace
}  // namespace flowdlo

int main(int argc, char** argv) {
  const std::string wanted = flowdlo::bench::wanted_device(argc, argv);
  if (const std::string gemm = flowdlo::bench::option(argc, argv, "--gemm="); !gemm.empty()) {
    flowdlo::vulkan::GemmChoice choice;
    if (std::sscanf(gemm.c_str(), "%dx%dx%d", &choice.rows, &choice.columns, &choice.depth) != 3) {
      std::fprintf(stderr, "--gemm: expected ROWSxCOLUMNSxDEPTH, got %s\n", gemm.c_str());
      return 2;
    }
    flowdlo::wanted_gemm = choice;
  }
  benchmark::Initialize(&argc, argv);
  const auto device = flowdlo::vulkan::open_device({.wanted = wanted});
  if (!device) {
    std::printf("skipped: %s\n", device.error().message.c_str());
    return 0;
  }
  std::printf("%s\n", flowdlo::vulkan::report(**device).name.c_str());
  flowdlo::register_all(*device);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
