// flowdlo_path_report [SCENES_PER_KIND [FIRST_SEED [KIND]]]: how often path::trace follows the
// rope, kind by kind. A traversal is right when it visits the true arclength in order: when the
// discrete Frechet distance of path and projected truth stays within a width (four under a bar).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "path/path.hpp"
#include "scene/scene.hpp"

namespace {

using Eigen::Vector2d;
using flowdlo::lab::Scene;

struct Target {
  std::vector<Vector2d> points_px;
  std::vector<double> tolerance_px;
};

Target target_of(const Scene& scene) {
  Target target;
  const auto& camera = scene.image.camera;
  for (const auto& p : flowdlo::lab::respaced(scene.curve, 0.7 * scene.radius_m)) {
    const Vector2d q{camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
    const double width = 2 * scene.radius_m * camera.fx / p.z();
    double tolerance = width + 3;
    for (const auto& bar : scene.bars) {
      const Vector2d d = q - bar.point_px;
      const double off = std::abs(bar.direction.x() * d.y() - bar.direction.y() * d.x());
      if (off < bar.half_width_px + width) tolerance = 4 * width + 3;
    }
    target.points_px.push_back(q);
    target.tolerance_px.push_back(tolerance);
  }
  return target;
}

// Whether both curves can be walked from start to end, never back, always within tolerance.
bool follows(const std::vector<Vector2d>& path, const Target& target) {
  const std::size_t n = target.points_px.size();
  std::vector<char> before(n, 0);
  std::vector<char> now(n, 0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const bool near = (path[i] - target.points_px[j]).norm() <= target.tolerance_px[j];
      bool reached = i == 0 && j == 0;
      if (i > 0) reached = reached || before[j] != 0 || (j > 0 && before[j - 1] != 0);
      if (j > 0) reached = reached || now[j - 1] != 0;
      now[j] = near && reached ? 1 : 0;
    }
    std::swap(before, now);
  }
  return before[n - 1] != 0;
}

bool right(const flowdlo::path::Path& path, const Target& target) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < path.points_px.size(); i += 2) {
    points.push_back(path.points_px[i].cast<double>());
  }
  points.push_back(path.points_px.back().cast<double>());
  if (follows(points, target)) return true;
  std::reverse(points.begin(), points.end());
  return follows(points, target);
}

struct Tally {
  int scenes = 0;
  int right = 0;
  int alternative = 0;  // wrong, but one of the alternatives is right
  int doubted = 0;      // wrong, with a margin below 0.5
  int none = 0;
  std::vector<double> ms;
  std::string wrong;
};

void measure(flowdlo::lab::Kind kind, std::uint64_t seed, Tally& tally) {
  const Scene scene = flowdlo::lab::make_scene(kind, seed);
  const auto start = std::chrono::steady_clock::now();
  const auto traced = flowdlo::path::trace(scene.frame());
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  tally.ms.push_back(took.count());
  ++tally.scenes;
  if (!traced) {
    ++tally.none;
    tally.wrong.append(" ").append(std::to_string(seed)).append("!");
    return;
  }
  const Target target = target_of(scene);
  if (right(traced->ranked.front(), target)) {
    ++tally.right;
    return;
  }
  const bool second = std::any_of(traced->ranked.begin() + 1, traced->ranked.end(),
                                  [&](const auto& path) { return right(path, target); });
  tally.alternative += second ? 1 : 0;
  tally.doubted += traced->margin < 0.5F ? 1 : 0;
  tally.wrong.append(" ").append(std::to_string(seed)).append(second ? "+" : "");
}

}  // namespace

int main(int count, char** values) {
  const int scenes = count > 1 ? std::stoi(values[1]) : 40;
  const std::uint64_t first = count > 2 ? std::stoull(values[2]) : 0;
  std::printf(
      "| kind | scenes | right | of the wrong: alternative right | margin < 0.5 | no path |"
      " ms p50 | ms p95 | wrong seeds |\n|---|---|---|---|---|---|---|---|---|\n");
  for (int k = 0; k < flowdlo::lab::kKinds; ++k) {
    const auto kind = static_cast<flowdlo::lab::Kind>(k);
    if (count > 3 && flowdlo::lab::name_of(kind) != values[3]) continue;
    Tally tally;
    for (int i = 0; i < scenes; ++i) measure(kind, first + static_cast<std::uint64_t>(i), tally);
    std::sort(tally.ms.begin(), tally.ms.end());
    std::printf("| %s | %d | %.1f %% | %d | %d | %d | %.1f | %.1f |%s |\n",
                std::string(flowdlo::lab::name_of(kind)).c_str(), tally.scenes,
                100.0 * tally.right / std::max(1, tally.scenes), tally.alternative, tally.doubted,
                tally.none, tally.ms[tally.ms.size() / 2], tally.ms[tally.ms.size() * 95 / 100],
                tally.wrong.c_str());
    std::fflush(stdout);
  }
  return 0;
}
