// flowdlo-lab curve-report: how far the true centerline of drawn scenes is from the chords between
// its 64 nodes, and from the smooth curve through them.
#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/estimate.hpp"
#include "geometry/camera.hpp"
#include "scene/scene.hpp"

namespace {

using Eigen::Vector3d;
using flowdlo::Point3;
using flowdlo::lab::Kind;

struct Options {
  int scenes = 100;
  std::uint64_t first = 900000;
  int points = 512;
};

/// Millimetres to the nearest place of a polyline.
double off_mm(const Vector3d& place, std::span<const Point3> line) {
  double least = std::numeric_limits<double>::infinity();
  Vector3d from = flowdlo::geometry::to_eigen(line.front()).cast<double>();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector3d to = flowdlo::geometry::to_eigen(line[i]).cast<double>();
    const Vector3d step = to - from;
    const double length = step.squaredNorm();
    const double t = length > 0 ? std::clamp((place - from).dot(step) / length, 0.0, 1.0) : 0;
    least = std::min(least, (place - from - t * step).squaredNorm());
    from = to;
  }
  return 1000 * std::sqrt(least);
}

/// Distances of true places, millimetres.
struct Offsets {
  std::vector<double> mm;

  void add(const flowdlo::lab::Curve3& truth, std::span<const Point3> line) {
    for (const Vector3d& place : truth) mm.push_back(off_mm(place, line));
  }
  void add(const Offsets& others) { mm.insert(mm.end(), others.mm.begin(), others.mm.end()); }
  [[nodiscard]] std::string text() {
    std::sort(mm.begin(), mm.end());
    double sum = 0;
    for (const double value : mm) sum += value;
    char line[80];
    std::snprintf(line, sizeof(line), "%.4f / %.4f / %.4f", sum / static_cast<double>(mm.size()),
                  mm[mm.size() * 99 / 100], mm.back());
    return line;
  }
};

int report(const Options& options) {
  std::printf(
      "mm from the true centerline: mean / 99 %% / most\n"
      "| kind | scenes | chords | curve(%d) |\n|---|---|---|---|\n",
      options.points);
  Offsets all_chords;
  Offsets all_curves;
  for (int k = 0; k < flowdlo::lab::kKinds; ++k) {
    const auto kind = static_cast<Kind>(k);
    Offsets chords;
    Offsets curves;
    for (int i = 0; i < options.scenes; ++i) {
      const auto scene =
          flowdlo::lab::make_scene(kind, options.first + static_cast<std::uint64_t>(i));
      flowdlo::Estimate estimate;
      estimate.nodes = scene.truth;
      const auto curve = estimate.curve(options.points);
      if (!curve) {
        std::fprintf(stderr, "%s\n", curve.error().message.c_str());
        return 1;
      }
      chords.add(scene.curve, scene.truth);
      curves.add(scene.curve, *curve);
    }
    all_chords.add(chords);
    all_curves.add(curves);
    std::printf("| %s | %d | %s | %s |\n", std::string(name_of(kind)).c_str(), options.scenes,
                chords.text().c_str(), curves.text().c_str());
    std::fflush(stdout);
  }
  std::printf("| all | %d | %s | %s |\n", options.scenes * flowdlo::lab::kKinds,
              all_chords.text().c_str(), all_curves.text().c_str());
  return 0;
}

}  // namespace

namespace flowdlo::lab {

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
      ->check(CLI::Range(2, flowdlo::kMostCurvePoints));
  support::set_action(app, exit_code, [options] { return ::report(*options); });
}

}  // namespace flowdlo::lab
