// flowdlo-lab sensor-report: how far nodes lie off along the ray and aside where the traversal is
// right, by what the depth is: a model of the sensor's noise, or pictures that were matched.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/refinement.hpp"
#include "eval/metrics.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "refine/refined.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"
#include "survey/wide_scenes.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kRightWidths = 1;  // a node farther aside than this is on another strand

struct Options {
  survey::WideScenes wide{.part = "training"};
  std::string field;  ///< empty: nodes as the prior has them
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

/// Each node from the nearest point of the true curve; nothing where a node is on another strand.
std::optional<Offsets> offsets(const Centerline& nodes, const Centerline& truth, double radius_m) {
  using geometry::to_eigen;
  const auto score = eval::score(nodes, truth);
  const Centerline turned = eval::turned(truth, score);
  Offsets result;
  survey::Values bias;
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
    bias.add(1000 * deeper);
    result.depth_mm += 1000 * std::abs(deeper) / kNodes;
    result.aside_mm += 1000 * across / kNodes;
  }
  result.bias_mm = bias.median();
  result.index_mm = 1000 * score.either_index_m;
  return result;
}

/// Of the best prior, refined where there is a network for it; nothing where there is no path, or
/// the prior is on other strands.
std::optional<Offsets> measured(const synth::SyntheticFrame& scene, refine::Network* network) {
  Timings timings;
  const auto conditions = estimator::gather(scene.frame(), {}, timings);
  if (!conditions) return std::nullopt;
  auto result =
      offsets(conditions->hypotheses.front().prior.nodes, scene.truth(), scene.meta.radius_m);
  if (result && network != nullptr) {
    const auto candidates =
        estimator::list_candidates({.hypotheses = conditions->hypotheses},
                                   conditions->paths.rope_width_px, {}, {}, {}, scene.frame(), 0);
    const auto nodes =
        refine::refined(estimator::curve_of(candidates.front()), scene.frame(), *network);
    if (!nodes) return std::nullopt;
    const auto refined = offsets(nodes->nodes, scene.truth(), scene.meta.radius_m);
    if (refined) result = refined;
  }
  if (result) {
    result->sensor = scene.meta.camera.substr(0, scene.meta.camera.find(' '));
    result->width_px = scene.meta.width_px;
  }
  return result;
}

using Network = std::optional<refine::Network>;
/// With depth by the noise model, and matched.
using Both = std::array<std::optional<Offsets>, 2>;

Result<Both> both(const Options& options, Network& network, std::uint64_t index) {
  Both found;
  for (const bool matched : {false, true}) {
    const auto scene = options.wide.make(index, {.color = false, .matched = matched});
    if (!scene) return scene.error();
    if (matched && !scene->meta.camera.ends_with("matched")) continue;
    found[matched ? 1 : 0] = measured(*scene, network ? &*network : nullptr);
  }
  return found;
}

std::string width_group(double px) {
  if (px < 4) return "width 2 to 4 px";
  return px < 8 ? "width 4 to 8 px" : "width 8 px and more";
}

struct Row {
  survey::Values bias, depth, aside, index;

  void add(const Offsets& of) {
    bias.add(of.bias_mm);
    depth.add(of.depth_mm);
    aside.add(of.aside_mm);
    index.add(of.index_mm);
  }
};

void print(const std::map<std::string, std::array<Row, 2>>& rows) {
  survey::Table table({"", "scenes", "model: bias", "along the ray", "aside", "index error",
                       "matched: bias", "along the ray", "aside", "index error"});
  for (const auto& [name, row] : rows) {
    std::vector<std::string> cells{name, std::to_string(row[0].bias.count())};
    for (const Row& of : row) {
      cells.push_back(fmt::format("{:+.2f}", of.bias.median()));
      for (const auto* values : {&of.depth, &of.aside, &of.index}) {
        cells.push_back(fmt::format("{:.2f}", values->median()));
      }
    }
    table.add(std::move(cells));
  }
  fmt::print("mm, medians over scenes\n{}", table.text());
}

int run(const Options& options) {
  std::optional<weights::RefineWeights> weights;
  if (!options.field.empty()) {
    const auto loaded = weights::load_field(options.field);
    if (!loaded) return survey::failed(loaded.error());
    if (!loaded->refine) {
      return survey::failed({ErrorCode::kBadInput,
                             options.field + ": expected a network that refines nodes, got none; "
                                             "make one with flowdlo-train refine"});
    }
    weights = loaded->refine;
  }
  const auto network = [&]() -> Result<Network> {
    if (!weights) return Network();
    auto made = refine::Network::create(*weights, [] { return reference::create_program(1); });
    if (!made) return made.error();
    return Network(*std::move(made));
  };
  std::map<std::string, std::array<Row, 2>> rows;
  for (const Both& found : survey::over<Both>(
           options.wide, network,
           [&](Network&own, std::uint64_t index) { return both(options, own, index); })) {
    if (!found[0] || !found[1]) continue;  // both, so that they compare
    for (const std::string& name :
         {std::string(" all"), found[0]->sensor, width_group(found[0]->width_px)}) {
      for (const std::size_t k : {0, 1}) rows[name][k].add(*found[k]);
    }
  }
  print(rows);
  return 0;
}

}  // namespace

void add_sensor_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "sensor-report",
      "Offsets of the best prior along the ray and aside, by sensor, where it is right");
  add_options(app, options->wide);
  app.add_option("--field", options->field,
                 "Refine the nodes by the network in FILE, a strand field's .safetensors")
      ->type_name("FILE");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
