// flowdlo-lab curve-report: how far the true centerline of drawn scenes is from the chords between
// its 64 nodes, and from the smooth curve through them.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/estimate.hpp"
#include "geometry/camera.hpp"
#include "scene/scene.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector3d;

struct Options {
  std::uint64_t scenes = 100;
  std::uint64_t first = 900000;
  int points = 512;
};

/// Millimetres to the nearest place of a polyline.
double off_mm(const Vector3d& place, std::span<const Point3> line) {
  double least = std::numeric_limits<double>::infinity();
  Vector3d from = geometry::to_eigen(line.front()).cast<double>();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector3d to = geometry::to_eigen(line[i]).cast<double>();
    const Vector3d step = to - from;
    const double length = step.squaredNorm();
    const double t = length > 0 ? std::clamp((place - from).dot(step) / length, 0.0, 1.0) : 0;
    least = std::min(least, (place - from - t * step).squaredNorm());
    from = to;
  }
  return 1000 * std::sqrt(least);
}

/// Millimetres of true places to the chords and to the curve.
struct Offsets {
  survey::Values chords;
  survey::Values curve;
};

void add(const Scene& scene, int points, Offsets& offsets) {
  Estimate estimate;
  estimate.nodes = scene.truth;
  const auto curve = estimate.curve(points);
  for (const Vector3d& place : scene.curve) {
    offsets.chords.add(off_mm(place, scene.truth));
    offsets.curve.add(off_mm(place, *curve));
  }
}

std::string text(const survey::Values& mm) {
  return fmt::format("{:.4f} / {:.4f} / {:.4f}", mm.mean(), mm.quantile(0.99), mm.most());
}

int report(const Options& options) {
  survey::Table table({"kind", "scenes", "chords", fmt::format("curve({})", options.points)});
  const auto add_row = [&](std::string_view name, std::uint64_t scenes, const Offsets& offsets) {
    table.add(
        {std::string(name), std::to_string(scenes), text(offsets.chords), text(offsets.curve)});
  };
  Offsets all;
  for (int k = 0; k < kKinds; ++k) {
    const auto kind = static_cast<Kind>(k);
    Offsets offsets;
    for (std::uint64_t i = 0; i < options.scenes; ++i) {
      add(make_scene(kind, options.first + i), options.points, offsets);
    }
    all.chords.add(offsets.chords);
    all.curve.add(offsets.curve);
    add_row(name_of(kind), options.scenes, offsets);
  }
  add_row("all", options.scenes * kKinds, all);
  fmt::print("mm from the true centerline: mean / 99 % / most\n{}", table.text());
  return 0;
}

}  // namespace

void add_curve_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "curve-report",
      "The true centerline of drawn scenes beside 64 chords and beside Estimate::curve");
  app.add_option("--scenes", options->scenes, "Of each kind")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--first", options->first, "Seed of the first scene of each kind")
      ->capture_default_str();
  app.add_option("--points", options->points, "Of the curve")
      ->capture_default_str()
      ->check(CLI::Range(2, kMostCurvePoints));
  support::set_action(app, exit_code, [options] { return report(*options); });
}

}  // namespace flowdlo::lab
