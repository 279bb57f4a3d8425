// flowdlo-lab sensor-report: how far nodes lie off along the ray and aside where the traversal is
// right, by what the depth is: a model of the sensor's noise, or pictures that were matched.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command/wide_scenes.hpp"
#include "command_line.hpp"
#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/refinement.hpp"
#include "eval/metrics.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "refine/refined.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/count.hpp"
#include "threads/team.hpp"
#include "weights/field_weights.hpp"

namespace {

namespace estimator = flowdlo::estimator;
namespace synth = flowdlo::synth;
using flowdlo::Centerline;
using flowdlo::kNodes;

constexpr double kRightWidths = 1;  // a node farther aside than this is on another strand

struct Options {
  flowdlo::lab::WideScenes wide{.part = "training"};
  std::string field;  ///< empty: nodes as the prior has them
  int threads = 0;
};

/// Of one scene, millimetres.
struct Offsets {
  std::string sensor;
  double width_px = 0;
  double bias_mm = 0;   ///< median over nodes, away from the camera above 0
  double depth_mm = 0;  ///< mean distance along the ray
  double aside_mm = 0;  ///< mean distance across both rope and ray
  double index_mm = 0;  ///< Eq. (4.1), in the better direction
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Each node from the nearest point of the true curve; nothing where a node is on another strand.
std::optional<Offsets> offsets(const Centerline& nodes, const Centerline& truth, double radius_m) {
  using flowdlo::geometry::to_eigen;
  const auto score = flowdlo::eval::score(nodes, truth);
  const Centerline turned = flowdlo::eval::turned(truth, score);
  Offsets result;
  std::vector<double> bias;
  for (int i = 0; i < kNodes; ++i) {
    const Eigen::Vector3f node = to_eigen(nodes[static_cast<std::size_t>(i)]);
    double least = 1e9;
    Eigen::Vector3f off(0, 0, 0);
    Eigen::Vector3f along(1, 0, 0);
    for (int k = std::max(1, i - 3); k <= std::min(kNodes - 1, i + 3); ++k) {
      const Eigen::Vector3f a = to_eigen(turned[static_cast<std::size_t>(k - 1)]);
      const Eigen::Vector3f way = to_eigen(turned[static_cast<std::size_t>(k)]) - a;
      const float t = std::clamp((node - a).dot(way) / way.squaredNorm(), 0.0F, 1.0F);
      const Eigen::Vector3f from = node - a - t * way;
      if (static_cast<double>(from.norm()) < least) {
        least = static_cast<double>(from.norm());
        off = from;
        along = way.normalized();
      }
    }
    const Eigen::Vector3f ray = node.normalized();
    const Eigen::Vector3f aside = along.cross(ray).normalized();
    const Eigen::Vector3f deep = aside.cross(along);
    const double sign = static_cast<double>(deep.dot(ray)) > 0 ? 1 : -1;
    const auto deeper = sign * static_cast<double>(off.dot(deep));
    const auto across = std::abs(static_cast<double>(off.dot(aside)));
    if (across > kRightWidths * 2 * radius_m) return std::nullopt;
    bias.push_back(1000 * deeper);
    result.depth_mm += 1000 * std::abs(deeper) / kNodes;
    result.aside_mm += 1000 * across / kNodes;
  }
  result.bias_mm = median(bias);
  result.index_mm = 1000 * score.either_index_m;
  return result;
}

/// Of the best prior, refined where there is a network for it; nothing where there is no path, or
/// the prior is on other strands.
std::optional<Offsets> measured(const synth::SyntheticFrame& scene,
                                flowdlo::refine::Network* network) {
  flowdlo::Timings timings;
  const auto conditions = estimator::gather(scene.frame(), {}, timings);
  if (!conditions) return std::nullopt;
  auto result =
      offsets(conditions->hypotheses.front().prior.nodes, scene.truth(), scene.meta.radius_m);
  if (result && network != nullptr) {
    const auto candidates =
        estimator::list_candidates({.hypotheses = conditions->hypotheses},
                                   conditions->paths.rope_width_px, {}, {}, {}, scene.frame(), 0);
    const auto nodes =
        flowdlo::refine::refined(estimator::curve_of(candidates.front()), scene.frame(), *network);
    if (!nodes) return std::nullopt;
    const auto refined = offsets(*nodes, scene.truth(), scene.meta.radius_m);
    if (refined) result = refined;
  }
  if (result) {
    result->sensor = scene.meta.camera.substr(0, scene.meta.camera.find(' '));
    result->width_px = scene.meta.width_px;
  }
  return result;
}

struct Row {
  std::vector<double> bias, depth, aside, index;

  void add(const Offsets& of) {
    bias.push_back(of.bias_mm);
    depth.push_back(of.depth_mm);
    aside.push_back(of.aside_mm);
    index.push_back(of.index_mm);
  }
};

std::string text(const Row& row) {
  if (row.bias.empty()) return " | | | ";
  return fmt::format("{:+.2f} | {:.2f} | {:.2f} | {:.2f}", median(row.bias), median(row.depth),
                     median(row.aside), median(row.index));
}

int run(const Options& options) {
  std::optional<flowdlo::weights::RefineWeights> weights;
  if (!options.field.empty()) {
    const auto loaded = flowdlo::weights::load_field(options.field);
    if (!loaded || !loaded->refine) {
      fmt::print(stderr, "{}\n",
                 loaded ? options.field +
                              ": expected a network that refines nodes, got none; make one with "
                              "flowdlo-train refine"
                        : loaded.error().message);
      return 1;
    }
    weights = loaded->refine;
  }
  std::map<std::string, std::array<Row, 2>> rows;
  std::mutex mutex;
  std::atomic<std::uint64_t> next = 0;
  flowdlo::threads::work_together(flowdlo::threads::count(options.threads), [&](int) {
    std::optional<flowdlo::refine::Network> network;
    if (weights) {
      auto made = flowdlo::refine::Network::create(
          *weights, [] { return flowdlo::reference::create_program(1); });
      if (!made) return;
      network = *std::move(made);
    }
    for (std::uint64_t i = next++; i < options.wide.scenes; i = next++) {
      std::array<std::optional<Offsets>, 2> found;
      for (const std::size_t matched : {0, 1}) {
        const auto scene =
            synth::make_frame(synth::Split::kWide, *synth::part_of(options.wide.part), 0,
                              options.wide.first + i, {.color = false, .matched = matched == 1});
        if (!scene) continue;
        if (matched == 1 && !scene->meta.camera.ends_with("matched")) continue;
        found[matched] = measured(*scene, network ? &*network : nullptr);
      }
      if (!found[0] || !found[1]) continue;  // both, so that they compare
      const double px = found[0]->width_px;
      const std::string width = px < 4   ? "width 2 to 4 px"
                                : px < 8 ? "width 4 to 8 px"
                                         : "width 8 px and more";
      const std::lock_guard lock(mutex);
      for (const std::string& name : {std::string(" all"), found[0]->sensor, width}) {
        for (const std::size_t k : {0, 1}) rows[name][k].add(*found[k]);
      }
    }
  });
  fmt::print(
      "mm, medians over scenes\n"
      "| | scenes | model: bias | along the ray | aside | index error | "
      "matched: bias | along the ray | aside | index error |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, row] : rows) {
    fmt::print("| {} | {} | {} | {} |\n", name, row[0].bias.size(), text(row[0]), text(row[1]));
  }
  return 0;
}

}  // namespace

namespace flowdlo::lab {

void add_sensor_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "sensor-report",
      "Offsets of the best prior along the ray and aside, by sensor, where it is right");
  add_options(app, options->wide);
  app.add_option("--field", options->field,
                 "Refine the nodes by the network in FILE, a strand field's .safetensors")
      ->type_name("FILE");
  add_threads_option(app, options->threads);
  support::set_action(app, exit_code, [options] { return ::run(*options); });
}

}  // namespace flowdlo::lab
