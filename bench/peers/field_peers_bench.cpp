// The strand field's network on FlowDLO's back ends, beside libtorch and ONNX Runtime: the same
// weights, the same planes, the same number of threads, in one process and in turns (A B C A B C).
// Results are compared before anything is timed.
//
// Timed: from a region's planes to its ten channels. Not timed: resampling and planes, ridges and
// tips. Once over all of a square of the region, where everyone computes the same; and once over
// the whole region of the frame, of which FlowDLO computes the blocks near the mask.
//
//   flowdlo_field_peers --weights W [--frame FRAME] [--onnxruntime libonnxruntime.so] [--threads 2]
//                       [--device vulkan]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "field/channel.hpp"
#include "peers/field_peers.hpp"
#include "peers/turns.hpp"
#include "reference/program.hpp"
#include "vulkan/backend.hpp"
#include "wide_lavapipe.hpp"

namespace flowdlo::peers {
namespace {

constexpr float kLargest = 2e-3F;  // difference to FlowDLO's CPU back end; Vulkan's weights are f16

struct Options {
  std::filesystem::path weights;
  std::filesystem::path frame = FLOWDLO_EXAMPLE_FRAME;
  std::filesystem::path onnxruntime;
  std::string device;
  int side = 320;
  int threads = 2;
  int rounds = 21;
};

using Peers = std::vector<std::unique_ptr<FieldPeer>>;

/// FlowDLO's CPU back end first. Peers that cannot be had are named, and why.
Peers make_peers(const Options& options, const FieldProblem& problem) {
  Peers peers;
  const auto take = [&](Result<std::unique_ptr<FieldPeer>> made, const char* name) {
    if (made) {
      peers.push_back(*std::move(made));
    } else {
      fmt::print("{}: left out: {}\n", name, made.error().message);
    }
  };
  take(flowdlo_field_peer(problem, "CPU back end",
                          [&] { return reference::create_program(problem.threads); }),
       "CPU back end");
  if (!options.device.empty()) {
    const auto opened = vulkan::open_device({.wanted = options.device});
    if (opened) {
      take(flowdlo_field_peer(problem, vulkan::report(**opened).name,
                              [device = *opened] { return vulkan::create_program(device); }),
           options.device.c_str());
    } else {
      fmt::print("{}: left out: {}\n", options.device, opened.error().message);
    }
  }
  peers.push_back(torch_field_peer(problem, /*channels_last=*/false));
  peers.push_back(torch_field_peer(problem, /*channels_last=*/true));
  if (options.onnxruntime.empty()) {
    fmt::print("ONNX Runtime: left out; name its library by --onnxruntime\n");
  } else {
    take(onnx_field_peer(problem, options.onnxruntime), "ONNX Runtime");
  }
  return peers;
}

/// Directions are compared as they are: their lengths are the network's too.
float difference(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size() || a.empty()) return INFINITY;
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const float off = std::abs(a[i] - b[i]);
    largest = off <= largest ? largest : off;  // a NaN stays
  }
  return largest;
}

float largest_of(const std::vector<float>& values) {
  return difference(values, std::vector<float>(values.size()));
}

bool agree(const Peers& peers) {
  std::vector<float> ours;
  peers.front()->see(&ours);
  const float size = largest_of(ours);
  bool fine = size > 0;
  for (std::size_t i = 1; i < peers.size(); ++i) {
    std::vector<float> theirs;
    peers[i]->see(&theirs);
    const float off = difference(ours, theirs) / size;
    fmt::print(
        "{}: largest difference to the CPU back end {:.2g} of the largest value (at most "
        "{:g})\n",
        peers[i]->name(), off, kLargest);
    fine = fine && off <= kLargest;
  }
  return fine;
}

void report(const Peers& peers, const FieldProblem& problem, int rounds) {
  std::vector<std::function<void()>> ways;
  for (const auto& peer : peers) ways.emplace_back([&] { peer->see(nullptr); });
  const auto turns = time_in_turns(ways, rounds);
  const double ours = percentile(turns.front(), &Turn::wall_ms, 0.5);
  const std::size_t all =
      problem.input.total() / static_cast<std::size_t>(field::kBlock_px * field::kBlock_px);
  fmt::print(
      "\n| {} x {} px, {} of {} blocks, {} threads | median ms | p95 ms | least ms | median CPU "
      "ms | CPU back end / this |\n|---|---|---|---|---|---|\n",
      problem.width(), problem.height(), problem.blocks.blocks.size(), all, problem.threads);
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const auto at = [&](double share) { return percentile(turns[i], &Turn::wall_ms, share); };
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", peers[i]->name(), at(0.5),
               at(0.95), at(0), percentile(turns[i], &Turn::cpu_ms, 0.5), ours / at(0.5));
  }
}

int failed(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return 2;
}

int run(const Options& options) {
  auto weights = weights::load_field(options.weights);
  if (!weights) return failed(weights.error());
  const auto region =
      region_problem(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                     options.frame, options.threads);
  if (!region) return failed(region.error());
  const FieldProblem dense = dense_problem(*region, options.side);
  const Peers of_dense = make_peers(options, dense);
  if (!agree(of_dense)) {
    fmt::print(stderr, "field peers: results differ; nothing was timed\n");
    return 1;
  }
  report(of_dense, dense, options.rounds);
  report(make_peers(options, *region), *region, options.rounds);
  return 0;
}

}  // namespace
}  // namespace flowdlo::peers

int main(int argc, char** argv) {
  flowdlo::peers::Options options;
  CLI::App app("The strand field's network beside libtorch and ONNX Runtime");
  app.add_option("--weights", options.weights, "Weights of the field, .safetensors")->required();
  app.add_option("--frame", options.frame, "A frame folder [the one that ships]");
  app.add_option("--onnxruntime", options.onnxruntime, "libonnxruntime.so [none]");
  app.add_option("--device", options.device, "A Vulkan device too, such as: llvmpipe [none]");
  app.add_option("--side", options.side, "Pixels of the square, whole blocks of 32")
      ->capture_default_str()
      ->check(CLI::Range(32, 2048));
  app.add_option("--threads", options.threads)->capture_default_str()->check(CLI::Range(1, 1024));
  app.add_option("--rounds", options.rounds)->capture_default_str()->check(CLI::Range(1, 10000));
  CLI11_PARSE(app, argc, argv);
  if (options.side % flowdlo::field::kBlock_px != 0) {
    fmt::print(stderr, "--side: expected a multiple of {}, got {}\n", flowdlo::field::kBlock_px,
               options.side);
    return 2;
  }
  if (!options.device.empty()) {
    // Mesa's CPU driver reads both once a process.
    ::setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 0);
    flowdlo::support::widen_lavapipe(options.device);
  }
  return flowdlo::peers::run(options);
}
