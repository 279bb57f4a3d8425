// flowdlo-lab stream-report: rendered scenes that stand still, each frame with its own noise. How
// often ends change places and curves jump, without hints and with the frame before; and what a
// frame before does that is wrong. Of several ropes: how often one takes another's number.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/tracker.hpp"
#include "geometry/polyline.hpp"
#include "reports/rope_identity.hpp"
#include "reports/steadiness.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"
#include "survey/wide_scenes.hpp"

namespace flowdlo::lab {
namespace {

constexpr float kMoved_m = 0.02F;

struct Options {
  std::string weights;
  survey::WideScenes wide{.part = "training", .first = 1000000, .scenes = 24, .threads = 1};
  int frames = 200;
  bool full = false;
  bool list = false;
  bool mislead = false;
  bool ropes = false;
  bool labels = false;
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
    if (geometry::mean_distance(other.nodes, estimate.nodes) > kJump_m) {
      return &other.nodes;
    }
  }
  return nullptr;
}

/// Colours take most of a scene's time, and nobody looks far from the mask.
std::vector<synth::Window> around_mask(const synth::SyntheticFrame& scene) {
  constexpr int kBeside_px = 64;
  const FrameFolder& folder = scene.folder;
  const cv::Rect mask = cv::boundingRect(cv::Mat1b(
      folder.height, folder.width, const_cast<std::uint8_t*>(folder.mask.data())));  // only read
  const cv::Rect window = cv::Rect(mask.x - kBeside_px, mask.y - kBeside_px,
                                   mask.width + 2 * kBeside_px, mask.height + 2 * kBeside_px) &
                          cv::Rect(0, 0, folder.width, folder.height);
  return {{window.x, window.y, window.br().x, window.br().y}};
}

Streams watch(const Options& options, std::uint64_t index, Estimator& estimator) {
  Streams streams;
  std::optional<Centerline> before;
  for (int k = 0; k < options.frames; ++k) {
    synth::Render render;
    render.frame = k;
    render.windows = around_mask;
    const auto scene = options.wide.make(index, render);
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
        nearest = std::min(nearest, geometry::mean_distance(other.nodes, *before));
      }
      streams.jumps_near += nearest < kJump_m ? 1 : 0;
      if (options.list) {
        fmt::print(stderr, "{} {} frame {}: jump of {:.2f} cm, nearest alternative {:.2f} cm\n",
                   index, streams.scenario, k,
                   100 * geometry::mean_distance(hinted->nodes, *before), 100 * nearest);
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

/// One scene of several ropes.
struct RopeStreams {
  int frames = 0;
  int shown = 0;  ///< ropes that the scene has
  int given = 0;  ///< numbers that the tracker gave
  RopeIdentity alone;
  RopeIdentity tracked;
};

RopeStreams watch_ropes(const Options& options, std::uint64_t index, Estimator& estimator) {
  RopeStreams streams;
  auto tracker = Tracker::create(std::move(estimator));
  if (!tracker) return streams;
  for (int k = 0; k < options.frames; ++k) {
    synth::Render render;
    render.frame = k;
    render.windows = around_mask;
    const auto scene = options.wide.make(index, render, synth::Split::kSeveral);
    if (!scene) break;
    streams.shown = static_cast<int>(scene->ropes.size());
    Frame frame = scene->frame();
    if (!options.labels) frame.instances = {};
    const auto alone = tracker->estimator()->estimate_ropes(frame);
    const auto tracked = tracker->estimate_ropes(frame);
    if (!alone || !tracked) continue;
    ++streams.frames;
    std::vector<int> indices(alone->ropes.size());
    std::iota(indices.begin(), indices.end(), 0);
    std::vector<Centerline> truths;
    for (const auto& rope : scene->ropes) truths.push_back(rope.nodes);
    streams.alone.add(alone->ropes, indices, truths);
    streams.tracked.add(tracked->found.ropes, tracked->numbers, truths);
    for (const int number : tracked->numbers) streams.given = std::max(streams.given, number);
  }
  estimator = std::move(*tracker->estimator());
  return streams;
}

int report_ropes(const Options& options) {
  const auto all = survey::over<RopeStreams>(
      options.wide, [&] { return survey::one_estimator(options.weights, Quality::kFast, 0); },
      [&](Estimator& estimator, std::uint64_t index) -> Result<RopeStreams> {
        RopeStreams streams = watch_ropes(options, index, estimator);
        if (options.list) {
          fmt::print(stderr, "{}: {} ropes, {} numbers given; alone {} mistaken, tracked {}\n",
                     index, streams.shown, streams.given, streams.alone.mistaken,
                     streams.tracked.mistaken);
        }
        return streams;
      });
  if (all.empty()) return 1;
  RopeStreams sum;
  for (const RopeStreams& one : all) {
    sum.frames += one.frames;
    sum.shown += one.shown;
    sum.given += one.given;
    sum.alone.add(one.alone);
    sum.tracked.add(one.tracked);
  }
  survey::Table table({"told by", "ropes", "another rope's number", "ends exchanged",
                       "rings begun elsewhere", "jumps over 1 cm", "over 1 cm off"});
  for (const auto& [name, of] :
       {std::pair("length, longest first", &sum.alone), std::pair("number", &sum.tracked)}) {
    table.add({name, std::to_string(of->ropes), std::to_string(of->mistaken),
               std::to_string(of->exchanged), std::to_string(of->begun), std::to_string(of->jumped),
               std::to_string(of->wrong)});
  }
  fmt::print("{}{} frames of {} scenes; of their {} ropes {} numbers were given\n", table.text(),
             sum.frames, all.size(), sum.shown, sum.given);
  return 0;
}

void tell(std::uint64_t index, const Streams& s) {
  fmt::print(stderr, "{} {}: alone {} exchanged {} jumps, previous {} and {}, {} switched\n", index,
             s.scenario, s.alone.exchanged, s.alone.jumps, s.previous.exchanged, s.previous.jumps,
             s.switched);
}

void add_row(const std::string& name, const Steadiness& s, survey::Table& table) {
  table.add({name, std::to_string(s.frames), std::to_string(s.exchanged), std::to_string(s.jumps),
             fmt::format("{:.3f}", 100 * s.error_m / std::max(1, s.frames)),
             fmt::format("{:.1f}", survey::percent(s.wrong, s.frames))});
}

int report(const Options& options) {
  const auto quality = options.full ? Quality::kFull : Quality::kFast;
  const auto all = survey::over<Streams>(
      options.wide, [&] { return survey::one_estimator(options.weights, quality); },
      [&](Estimator& estimator, std::uint64_t index) -> Result<Streams> {
        Streams streams = watch(options, index, estimator);
        if (!streams.failure.empty()) fmt::print(stderr, "{}: {}\n", index, streams.failure);
        if (options.list) tell(index, streams);
        return streams;
      });
  if (all.empty()) return 1;
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
  survey::Table table({"hints", "frames", "ends exchanged", "jumps over 1 cm", "mean error, cm",
                       "frames over 1 cm, %"});
  add_row("none", sum.alone, table);
  add_row("the frame before", sum.previous, table);
  if (options.mislead) {
    add_row("this frame's nodes, 2 cm beside", sum.moved, table);
    add_row("a runner-up as the frame before", sum.misled, table);
  }
  fmt::print(
      "{}with the frame before {} frames took another way; of its jumps {} had an alternative "
      "near the frame before; a runner-up was followed in {} frames\n",
      table.text(), sum.switched, sum.jumps_near, sum.followed);
  return 0;
}

}  // namespace

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
  app.add_flag("--full", options->full, "All steps and draws, not quality fast");
  app.add_flag("--mislead", options->mislead,
               "Also with a wrong frame before: the best alternative that runs elsewhere");
  app.add_flag("--list", options->list, "Every scene and every jump on stderr");
  auto* const ropes =
      app.add_flag("--ropes", options->ropes,
                   "Scenes of several ropes: by length as they come, and by the tracker's numbers");
  app.add_flag("--labels", options->labels, "Each pixel is labelled with its rope")->needs(ropes);
  support::set_action(app, exit_code, [options] {
    return options->ropes ? report_ropes(*options) : report(*options);
  });
}

}  // namespace flowdlo::lab
