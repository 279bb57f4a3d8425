// The frame's model part on the CPU, beside its peers: the same weights, the same frame, the same
// number of threads, in one process and in turns (A B C A B C). Results are compared before
// anything is timed.
//
// Timed: normalised prior and point tokens, keys and values of the points once, then K Euler steps
// of all draws, each with the local features read from the mask field by the engine's own function.
// Not timed: evidence, path, prior, farthest-point sampling, the mask field itself, the gate.
//
//   flowdlo_peers --weights W [--frame FRAME] [--onnxruntime libonnxruntime.so] [--threads 2] ...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "peers/flowdlo_peer.hpp"
#include "peers/onnx_peer.hpp"
#include "peers/problem.hpp"
#include "peers/torch_peer.hpp"
#include "peers/turns.hpp"

namespace flowdlo::peers {
namespace {

constexpr float kLargest = 1e-3F;  // difference to FlowDLO, of what the network adds to the nodes

struct Options {
  std::filesystem::path weights;
  std::filesystem::path frame = FLOWDLO_EXAMPLE_FRAME;
  std::filesystem::path onnxruntime;
  int threads = 2;
  int draws = 4;
  int steps = 10;
  int rounds = 21;
};

/// Largest difference of the nodes' coordinates.
float difference(const std::vector<float>& a, const std::vector<float>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 == 3) continue;
    const float off = std::abs(a[i] - b[i]);
    largest = off <= largest ? largest : off;  // a NaN stays
  }
  return largest;
}

std::vector<std::unique_ptr<Peer>> make_peers(const Options& options, const Problem& problem) {
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(flowdlo_peer(problem));
  peers.push_back(torch_peer(problem));
  if (options.onnxruntime.empty()) {
    fmt::print("ONNX Runtime: left out; name its library by --onnxruntime\n");
  } else if (auto peer = onnx_peer(problem, options.onnxruntime)) {
    peers.push_back(*std::move(peer));
  } else {
    fmt::print("ONNX Runtime: left out: {}\n", peer.error().message);
  }
  return peers;
}

bool agree(const std::vector<std::unique_ptr<Peer>>& peers, const Problem& problem) {
  std::vector<float> ours(problem.source.size());
  peers.front()->sample(ours);
  const float share = difference(ours, problem.without_network());
  bool fine = share > 0;
  for (std::size_t i = 1; i < peers.size(); ++i) {
    std::vector<float> theirs(problem.source.size());
    peers[i]->sample(theirs);
    const float off = difference(ours, theirs) / share;
    fmt::print("{}: largest difference to FlowDLO {:.2g} of the network's share (at most {:g})\n",
               peers[i]->name(), off, kLargest);
    fine = fine && off <= kLargest;
  }
  return fine;
}

int run(const Options& options) {
  const auto problem =
      make_problem(options.weights, options.frame, options.draws, options.steps, options.threads);
  if (!problem) {
    fmt::print(stderr, "{}\n", problem.error().message);
    return 2;
  }
  const auto peers = make_peers(options, *problem);
  if (!agree(peers, *problem)) {
    fmt::print(stderr, "peers: results differ; nothing was timed\n");
    return 1;
  }
  std::vector<float> state(problem->source.size());
  std::vector<std::function<void()>> ways;
  for (const auto& peer : peers) ways.emplace_back([&] { peer->sample(state); });
  const auto turns = time_in_turns(ways, options.rounds);
  const double ours = percentile(turns.front(), &Turn::wall_ms, 0.5);
  fmt::print("\n{} draws, {} steps, {} threads, {} rounds in turns\n\n", options.draws,
             options.steps, options.threads, options.rounds);
  fmt::print(
      "| model part of a frame | median ms | p95 ms | least ms | median CPU ms | FlowDLO / this |"
      "\n|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const auto at = [&](double share) { return percentile(turns[i], &Turn::wall_ms, share); };
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", peers[i]->name(), at(0.5),
               at(0.95), at(0), percentile(turns[i], &Turn::cpu_ms, 0.5), ours / at(0.5));
  }
  return 0;
}

}  // namespace
}  // namespace flowdlo::peers

int main(int argc, char** argv) {
  flowdlo::peers::Options options;
  CLI::App app("FlowDLO's CPU back end beside libtorch and ONNX Runtime");
  app.add_option("--weights", options.weights, "A .fdw file")->required();
  app.add_option("--frame", options.frame, "A frame folder [the one that ships]");
  app.add_option("--onnxruntime", options.onnxruntime, "libonnxruntime.so [none]");
  app.add_option("--threads", options.threads)->capture_default_str()->check(CLI::Range(1, 1024));
  app.add_option("--draws", options.draws)->capture_default_str()->check(CLI::Range(1, 64));
  app.add_option("--steps", options.steps)->capture_default_str()->check(CLI::Range(1, 64));
  app.add_option("--rounds", options.rounds)->capture_default_str()->check(CLI::Range(1, 10000));
  CLI11_PARSE(app, argc, argv);
  return flowdlo::peers::run(options);
}
