// mask_bench FRAME: milliseconds of each way to a mask, one thread, on a frame folder with colour.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <vector>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/mask.hpp"

namespace {

using flowdlo::FrameFolder;

template <class Make>
void run(benchmark::State& state, const Make& make) {
  for (auto _ : state) {
    const auto mask = make();
    if (!mask) {
      state.SkipWithError(mask.error().message.c_str());
      return;
    }
    benchmark::DoNotOptimize(mask->data());
  }
}

void add(const FrameFolder& folder) {
  const auto add_one = [](const char* name, auto make) {
    benchmark::RegisterBenchmark(name, [make](benchmark::State& state) {
      run(state, make);
    })->Unit(benchmark::kMillisecond);
  };
  // The colour of a masked pixel, and that pixel: every way finds something.
  std::size_t pixel = 0;
  while (pixel + 1 < folder.mask.size() && folder.mask[pixel] <= 127) ++pixel;
  const auto width = static_cast<std::size_t>(folder.width);
  const flowdlo::ColorBand band{.red = folder.color_bgr[3 * pixel + 2],
                                .green = folder.color_bgr[3 * pixel + 1],
                                .blue = folder.color_bgr[3 * pixel]};
  const std::vector<flowdlo::Pixel> seed{
      {static_cast<float>(pixel % width), static_cast<float>(pixel / width)}};
  add_one("mask_from_color", [&folder, band] { return mask_from_color(folder.frame(), band); });
  add_one("mask_from_plane", [&folder] { return mask_from_plane(folder.frame(), {}); });
  add_one("mask_from_seeds", [&folder, seed] { return mask_from_seeds(folder.frame(), seed); });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: mask_bench FRAME [--benchmark_...]\n");
    return 2;
  }
  const auto folder = flowdlo::load_frame_folder(argv[1]);
  if (!folder || folder->color_bgr.empty()) {
    std::fprintf(stderr, "%s\n", folder ? "no color.png" : folder.error().message.c_str());
    return 1;
  }
  add(*folder);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
