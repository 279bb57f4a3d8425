// Time of path::trace on one core, scene by scene. Budget: 8 ms at 640 x 480, 20 ms at 1280 x 720.
// Every result is checked before it is timed.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

#include "path/path.hpp"
#include "scene/scene.hpp"

namespace {

using flowdlo::lab::Kind;
using flowdlo::lab::Scene;

// The first `count` scenes of that kind and width.
std::vector<Scene> scenes(Kind kind, int width, int count) {
  std::vector<Scene> result;
  for (std::uint64_t seed = 0; static_cast<int>(result.size()) < count; ++seed) {
    Scene scene = flowdlo::lab::make_scene(kind, seed);
    if (scene.image.width == width) result.push_back(std::move(scene));
  }
  return result;
}

void trace(benchmark::State& state) {
  const auto kind = static_cast<Kind>(state.range(0));
  const auto all = scenes(kind, static_cast<int>(state.range(1)), 4);
  for (const Scene& scene : all) {
    const auto traced = flowdlo::path::trace(scene.frame());
    if (!traced || traced->ranked.front().points_px.size() < 64) {
      state.SkipWithError("no path");
      return;
    }
  }
  std::size_t next = 0;
  for (auto _ : state) {
    auto traced = flowdlo::path::trace(all[next++ % all.size()].frame());
    benchmark::DoNotOptimize(traced);
  }
  state.SetLabel(std::string(flowdlo::lab::name_of(kind)));
}

void kinds_and_sizes(benchmark::internal::Benchmark* bench) {
  for (int kind = 0; kind < flowdlo::lab::kKinds; ++kind) {
    for (const int width : {640, 1280}) bench->Args({kind, width});
  }
}

BENCHMARK(trace)->Apply(kinds_and_sizes)->Unit(benchmark::kMillisecond)->MinTime(0.3);

}  // namespace
