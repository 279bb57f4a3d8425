// flowdlo_prior_report [--scenes N] [--first SEED] [--kind K] [--overlays DIR] [--worst N]:
// mean index error, Eq. (4.1), of the thesis' and of the refined prior against the truth in the
// better of both directions, kind by kind; over all scenes, over those whose path is right, and on
// the true path. The worst scenes are listed (a wrong path is marked so), --overlays draws them.
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "eval/metrics.hpp"
#include "evidence/visible_points.hpp"
#include "geometry/camera.hpp"
#include "path/path.hpp"
#include "prior/refined_prior.hpp"
#include "prior_report/overlay.hpp"
#include "prior_report/traversal.hpp"
#include "scene/scene.hpp"

namespace {

using flowdlo::Centerline;
using flowdlo::kNodes;
using flowdlo::lab::Scene;

struct Options {
  int scenes = 40;
  std::uint64_t first = 0;
  std::string kind;
  std::string overlays;
  int worst = 5;
};

struct Error {
  double index_cm = 0;
  bool flipped = false;
};

// The truth turned to the direction of `nodes`.
Centerline turned(const Centerline& truth, const Centerline& nodes) {
  return flowdlo::eval::turned(truth, flowdlo::eval::score(nodes, truth));
}

Error error_of(const Centerline& nodes, const Centerline& truth) {
  const flowdlo::eval::Score score = flowdlo::eval::score(nodes, truth);
  return {100 * score.either_index_m, score.flipped};
}

// Signed offsets from the truth of the estimate's ends, outwards; and mean distances: along the
// ray, aside, and along the rope.
struct Parts {
  double end_cm[2] = {0, 0};
  double depth_cm = 0;
  double bias_cm = 0;
  double aside_cm = 0;
  double along_cm = 0;
};

Parts parts_of(const Centerline& nodes, const Centerline& truth_any) {
  const Centerline truth = turned(truth_any, nodes);
  Parts parts;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto p = flowdlo::geometry::to_eigen(truth[i]);
    const auto a = flowdlo::geometry::to_eigen(truth[i > 0 ? i - 1 : i]);
    const auto b = flowdlo::geometry::to_eigen(truth[std::min<std::size_t>(i + 1, kNodes - 1)]);
    const Eigen::Vector3f along = (b - a).normalized();
    const Eigen::Vector3f aside = along.cross(p).normalized();
    const Eigen::Vector3f deep = aside.cross(along);
    const Eigen::Vector3f off = flowdlo::geometry::to_eigen(nodes[i]) - p;
    const double sign = deep.dot(p) > 0 ? 1 : -1;
    parts.depth_cm += 100.0 / kNodes * std::abs(static_cast<double>(off.dot(deep)));
    parts.bias_cm += 100.0 / kNodes * sign * static_cast<double>(off.dot(deep));
    parts.aside_cm += 100.0 / kNodes * std::abs(static_cast<double>(off.dot(aside)));
    parts.along_cm += 100.0 / kNodes * std::abs(static_cast<double>(off.dot(along)));
    if (i == 0) parts.end_cm[0] = -100 * static_cast<double>(off.dot(along));
    if (i + 1 == kNodes) parts.end_cm[1] = 100 * static_cast<double>(off.dot(along));
  }
  return parts;
}

struct Errors {
  std::vector<double> cm;

  void add(double value) { cm.push_back(value); }
  void print() {
    if (cm.empty()) {
      std::printf(" - |");
      return;
    }
    std::sort(cm.begin(), cm.end());
    double sum = 0;
    for (const double value : cm) sum += value;
    std::printf(" %.3f / %.3f / %.3f |", sum / static_cast<double>(cm.size()), cm[cm.size() / 2],
                cm[cm.size() * 95 / 100]);
  }
};

struct Case {
  std::uint64_t seed;
  double index_cm;
  Parts parts;
  bool right;
};

struct Tally {
  int scenes = 0;
  int right = 0;
  int failed = 0;
  int flips = 0;
  Errors thesis_all, refined_all, thesis_right, refined_right, refined_truth;
  std::vector<double> thesis_ms, refined_ms;
  std::vector<Case> cases;
};

template <class Work>
auto timed(std::vector<double>& ms, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  ms.push_back(took.count());
  return result;
}

void measure(flowdlo::lab::Kind kind, std::uint64_t seed, Tally& tally) {
  namespace prior = flowdlo::prior;
  const Scene scene = flowdlo::lab::make_scene(kind, seed);
  const flowdlo::Frame frame = scene.frame();
  ++tally.scenes;
  const auto cloud = flowdlo::evidence::unproject(frame);
  const auto visible = flowdlo::evidence::visible_points(cloud);
  const auto traced = flowdlo::path::trace(frame);
  if (!traced) {
    ++tally.failed;
    return;
  }
  const auto& path = traced->ranked.front();
  const float width_px = traced->rope_width_px;
  const auto thesis = timed(tally.thesis_ms, [&] { return prior::lift(path, visible, frame); });
  const auto refined =
      timed(tally.refined_ms, [&] { return prior::refine(path, width_px, cloud, visible, frame); });
  const auto best = prior::refine(flowdlo::lab::true_path(scene), width_px, cloud, visible, frame);
  if (!thesis || !refined) {
    ++tally.failed;
    return;
  }
  const Error thesis_error = error_of(thesis->nodes, scene.truth);
  const Error refined_error = error_of(refined->nodes, scene.truth);
  tally.thesis_all.add(thesis_error.index_cm);
  tally.refined_all.add(refined_error.index_cm);
  tally.flips += refined_error.flipped ? 1 : 0;
  if (best) tally.refined_truth.add(error_of(best->nodes, scene.truth).index_cm);
  const bool right = flowdlo::lab::follows_rope(path, scene);
  tally.cases.push_back(
      {seed, refined_error.index_cm, parts_of(refined->nodes, scene.truth), right});
  if (!right) return;
  ++tally.right;
  tally.thesis_right.add(thesis_error.index_cm);
  tally.refined_right.add(refined_error.index_cm);
}

void draw(flowdlo::lab::Kind kind, const Case& bad, const std::string& folder) {
  const Scene scene = flowdlo::lab::make_scene(kind, bad.seed);
  const flowdlo::Frame frame = scene.frame();
  const auto cloud = flowdlo::evidence::unproject(frame);
  const auto visible = flowdlo::evidence::visible_points(cloud);
  const auto traced = flowdlo::path::trace(frame);
  if (!traced) return;
  const auto refined =
      flowdlo::prior::refine(traced->ranked.front(), traced->rope_width_px, cloud, visible, frame);
  if (!refined) return;
  const std::string file = folder + "/" + std::string(flowdlo::lab::name_of(kind)) + "_" +
                           std::to_string(bad.seed) + ".png";
  if (!save_overlay(file, scene, turned(scene.truth, refined->nodes), *refined)) {
    std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
  }
}

void report(flowdlo::lab::Kind kind, const Options& options) {
  Tally tally;
  for (int i = 0; i < options.scenes; ++i) {
    measure(kind, options.first + static_cast<std::uint64_t>(i), tally);
  }
  std::printf("| %s | %d | %d | %d | %d |", std::string(flowdlo::lab::name_of(kind)).c_str(),
              tally.scenes, tally.right, tally.failed, tally.flips);
  for (Errors* errors : {&tally.thesis_all, &tally.refined_all, &tally.thesis_right,
                         &tally.refined_right, &tally.refined_truth}) {
    errors->print();
  }
  for (auto* ms : {&tally.thesis_ms, &tally.refined_ms}) {
    std::sort(ms->begin(), ms->end());
    if (!ms->empty()) std::printf(" %.2f / %.2f |", (*ms)[ms->size() / 2], ms->back());
  }
  std::printf("\n");
  std::sort(tally.cases.begin(), tally.cases.end(),
            [](const Case& a, const Case& b) { return a.index_cm > b.index_cm; });
  for (int i = 0; i < std::min(options.worst, static_cast<int>(tally.cases.size())); ++i) {
    const Case& bad = tally.cases[static_cast<std::size_t>(i)];
    std::fprintf(stderr,
                 "  %s seed %llu: %.3f cm%s; depth %.3f (bias %+.3f), aside %.3f, along %.3f, ends "
                 "%+.2f %+.2f\n",
                 std::string(flowdlo::lab::name_of(kind)).c_str(),
                 static_cast<unsigned long long>(bad.seed), bad.index_cm,
                 bad.right ? "" : " (wrong)", bad.parts.depth_cm, bad.parts.bias_cm,
                 bad.parts.aside_cm, bad.parts.along_cm, bad.parts.end_cm[0], bad.parts.end_cm[1]);
    if (!options.overlays.empty()) draw(kind, bad, options.overlays);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** values) {
  Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string_view name = values[i];
    if (name == "--scenes") options.scenes = std::stoi(values[i + 1]);
    if (name == "--first") options.first = std::stoull(values[i + 1]);
    if (name == "--kind") options.kind = values[i + 1];
    if (name == "--overlays") options.overlays = values[i + 1];
    if (name == "--worst") options.worst = std::stoi(values[i + 1]);
  }
  std::printf(
      "mean / median / 95 %% index error, cm; ms: median / most\n"
      "| kind | scenes | right | failed | flips | thesis, all | refined, all | thesis, right |"
      " refined, right | refined, true path | thesis ms | refined ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int k = 0; k < flowdlo::lab::kKinds; ++k) {
    const auto kind = static_cast<flowdlo::lab::Kind>(k);
    if (!options.kind.empty() && flowdlo::lab::name_of(kind) != options.kind) continue;
    report(kind, options);
  }
  return 0;
}
