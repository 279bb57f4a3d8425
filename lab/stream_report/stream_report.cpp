// flowdlo-lab stream-report: rendered scenes that stand still, each frame with its own noise. How
// often ends change places and curves jump, without hints and with the frame before; and what a
// frame before does that is wrong.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "command/report_commands.hpp"
#include "command/wide_scenes.hpp"
#include "command_line.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "stream_report/steadiness.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/count.hpp"

namespace {

namespace synth = flowdlo::synth;
using flowdlo::Centerline;
using flowdlo::Config;
using flowdlo::Estimate;
using flowdlo::Estimator;
using flowdlo::Frame;
using flowdlo::lab::Steadiness;

constexpr float kMoved_m = 0.02F;

struct Options {
  std::string weights;
  flowdlo::lab::WideScenes wide{.part = "training", .first = 1000000, .scenes = 24};
  int frames = 200;
  int threads = 1;
  bool full = false;
  bool list = false;
  bool mislead = false;
};

/// One scene under each condition.
struct Streams {
  std::string scenario;
  Steadiness alone;
  Steadiness previous;
  Steadiness moved;    ///< the frame before is this frame's, two centimetres to the right
  Steadiness misled;   ///< the frame before is the best alternative that runs elsewhere
  int switched = 0;    ///< frames that `previous` gave another way
  int followed = 0;    ///< frames in which the misleading frame before was taken, of those misled
  int jumps_near = 0;  ///< jumps with `previous` where an alternative is near the frame before
  std::string failure;
};

/// The best alternative that is no other sight of the same way.
const Centerline* elsewhere(const Estimate& estimate) {
  for (const auto& other : estimate.alternatives) {
    if (flowdlo::geometry::mean_distance(other.nodes, estimate.nodes) > flowdlo::lab::kJump_m) {
      return &other.nodes;
    }
  }
  return nullptr;
}

/// Colours take most of a scene's time, and nobody looks far from the mask.
std::vector<synth::Window> around_mask(const synth::SyntheticFrame& scene) {
  constexpr int kBeside_px = 64;
  const auto& folder = scene.folder;
  synth::Window window{folder.width, folder.height, 0, 0};
  for (int v = 0; v < folder.height; ++v) {
    for (int u = 0; u < folder.width; ++u) {
      const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(folder.width) +
                      static_cast<std::size_t>(u);
      if (folder.mask[at] == 0) continue;
      window.left = std::min(window.left, u - kBeside_px);
      window.top = std::min(window.top, v - kBeside_px);
      window.right = std::max(window.right, u + 1 + kBeside_px);
      window.bottom = std::max(window.bottom, v + 1 + kBeside_px);
    }
  }
  window.left = std::max(0, window.left);
  window.top = std::max(0, window.top);
  window.right = std::min(folder.width, window.right);
  window.bottom = std::min(folder.height, window.bottom);
  return {window};
}

Streams watch(const Options& options, std::uint64_t index, Estimator& estimator) {
  Streams streams;
  std::optional<Centerline> before;
  for (int k = 0; k < options.frames; ++k) {
    synth::Render render;
    render.frame = k;
    render.windows = around_mask;
    const auto scene = synth::make_frame(synth::Split::kWide, *synth::part_of(options.wide.part), 0,
                                         index, render);
    if (!scene) {
      streams.failure = scene.error().message;
      return streams;
    }
    streams.scenario = scene->meta.scenario;
    const Frame frame = scene->frame();
    const auto alone = estimator.estimate(frame);
    if (!alone) {
      streams.failure = alone.error().message;
      continue;
    }
    streams.alone.add(alone->nodes, scene->truth());
    const auto hinted = estimator.estimate(frame, {.previous = before});
    if (!hinted) {
      streams.failure = hinted.error().message;
      continue;
    }
    const bool jumped = streams.previous.add(hinted->nodes, scene->truth());
    streams.switched += hinted->switched ? 1 : 0;
    if (jumped) {
      double nearest = 1;
      for (const auto& other : hinted->alternatives) {
        nearest = std::min(nearest, flowdlo::geometry::mean_distance(other.nodes, *before));
      }
      streams.jumps_near += nearest < flowdlo::lab::kJump_m ? 1 : 0;
      if (options.list) {
        fmt::print(stderr, "{} {} frame {}: jump of {:.2f} cm, nearest alternative {:.2f} cm\n",
                   index, streams.scenario, k,
                   100 * flowdlo::geometry::mean_distance(hinted->nodes, *before), 100 * nearest);
      }
    }
    before = hinted->nodes;
    if (!options.mislead) continue;
    Centerline beside = alone->nodes;
    for (auto& node : beside) node.x += kMoved_m;
    if (const auto moved = estimator.estimate(frame, {.previous = beside})) {
      streams.moved.add(moved->nodes, scene->truth());
    }
    if (const Centerline* wrong = elsewhere(*alone)) {
      const auto misled = estimator.estimate(frame, {.previous = *wrong});
      if (!misled) continue;
      streams.misled.add(misled->nodes, scene->truth());
      streams.followed += misled->switched ? 1 : 0;
    } else {
      streams.misled.add(alone->nodes, scene->truth());
    }
  }
  return streams;
}

std::string row(const std::string& name, const Steadiness& s) {
  const double n = std::max(1, s.frames);
  return fmt::format("| {} | {} | {} | {} | {:.3f} | {:.1f} |", name, s.frames, s.exchanged,
                     s.jumps, 100 * s.error_m / n, 100 * s.wrong / n);
}

int report(const Options& options) {
  std::vector<Streams> all(static_cast<std::size_t>(options.wide.scenes));
  std::atomic<std::uint64_t> next = 0;
  std::mutex telling;
  std::string failure;
  std::vector<std::thread> threads;
  for (int j = 0; j < flowdlo::threads::count(options.threads); ++j) {
    threads.emplace_back([&] {
      Config config;
      config.weights = options.weights;
      config.device = "cpu";
      config.threads = 1;
      config.quality = options.full ? flowdlo::Quality::kFull : flowdlo::Quality::kFast;
      config.max_width = 1920;
      config.max_height = 1080;
      auto estimator = Estimator::create(config);
      if (!estimator) {
        const std::lock_guard lock(telling);
        failure = estimator.error().message;
        return;
      }
      for (std::size_t at = next++; at < all.size(); at = next++) {
        all[at] = watch(options, options.wide.first + at, *estimator);
        const std::lock_guard lock(telling);
        const Streams& s = all[at];
        if (!s.failure.empty()) fmt::print(stderr, "{}: {}\n", options.wide.first + at, s.failure);
        if (options.list) {
          fmt::print(stderr,
                     "{} {}: alone {} exchanged {} jumps, previous {} and {}, {} switched\n",
                     options.wide.first + at, s.scenario, s.alone.exchanged, s.alone.jumps,
                     s.previous.exchanged, s.previous.jumps, s.switched);
        }
      }
    });
  }
  for (auto& thread : threads) thread.join();
  if (!failure.empty()) {
    fmt::print(stderr, "{}\n", failure);
    return 1;
  }
  Streams sum;
  for (const Streams& one : all) {
    sum.alone.add(one.alone);
    sum.previous.add(one.previous);
    sum.moved.add(one.moved);
    sum.misled.add(one.misled);
    sum.switched += one.switched;
    sum.followed += one.followed;
    sum.jumps_near += one.jumps_near;
  }
  fmt::print(
      "| hints | frames | ends exchanged | jumps over 1 cm | mean error, cm | frames over 1 cm, % "
      "|\n|---|---|---|---|---|---|\n{}\n{}\n",
      row("none", sum.alone), row("the frame before", sum.previous));
  if (options.mislead) {
    fmt::print("{}\n{}\n", row("this frame's nodes, 2 cm beside", sum.moved),
               row("a runner-up as the frame before", sum.misled));
  }
  fmt::print(
      "with the frame before {} frames took another way; of its jumps {} had an alternative "
      "near the frame before; a runner-up was followed in {} frames\n",
      sum.switched, sum.jumps_near, sum.followed);
  return 0;
}

}  // namespace

namespace flowdlo::lab {

void add_stream_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "stream-report",
      "How steady estimates of still scenes are, frame by frame with fresh noise");
  app.add_option("--weights", options->weights, "A .fdw file [the one that ships]")
      ->type_name("FILE");
  add_options(app, options->wide);
  app.add_option("--frames", options->frames, "Of each scene")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  add_threads_option(app, options->threads);
  app.add_flag("--full", options->full, "All steps and draws, not quality fast");
  app.add_flag("--mislead", options->mislead,
               "Also with a wrong frame before: the best alternative that runs elsewhere");
  app.add_flag("--list", options->list, "Every scene and every jump on stderr");
  support::set_action(app, exit_code, [options] { return ::report(*options); });
}

}  // namespace flowdlo::lab
