// How the cost of a frame grows on the CPU back end: with draws D, steps K, threads, and the size
// of the mask. The least of many calls, on the frame that ships: what else a shared machine does
// makes the others longer.
//
//   flowdlo_scaling [--weights W] [--out docs/scaling.png]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "pictures/panels.hpp"

namespace flowdlo {
namespace {

// A new thread may share its maker's core for a while on a machine whose others are taken.
constexpr std::chrono::milliseconds kLeast{1200};

struct Options {
  std::filesystem::path weights;
  std::filesystem::path frame = FLOWDLO_EXAMPLE_FRAME;
  std::filesystem::path out = "scaling.png";
  int frames = 5;
};

/// The frame enlarged to `width` x `height`, each pixel that of the nearest place.
FrameFolder enlarged(const FrameFolder& folder, int width, int height) {
  FrameFolder result = folder;
  result.width = width;
  result.height = height;
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  result.mask.resize(size);
  result.depth_m.resize(size);
  result.color_bgr.clear();
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto to = static_cast<std::size_t>(v) * width + u;
      const auto from = static_cast<std::size_t>(v * folder.height / height) * folder.width +
                        static_cast<std::size_t>(u * folder.width / width);
      result.mask[to] = folder.mask[from];
      result.depth_m[to] = folder.depth_m[from];
    }
  }
  const float across = static_cast<float>(width) / static_cast<float>(folder.width);
  const float down = static_cast<float>(height) / static_cast<float>(folder.height);
  result.intrinsics.fx *= across;
  result.intrinsics.cx = (result.intrinsics.cx + 0.5F) * across - 0.5F;
  result.intrinsics.fy *= down;
  result.intrinsics.cy = (result.intrinsics.cy + 0.5F) * down - 0.5F;
  return result;
}

using Measures = std::vector<std::function<double(const Timings&)>>;

/// What each of `measures` reads, its least over the calls; negative without an estimate.
std::vector<double> timed(const Options& options, const Config& config, const FrameFolder& folder,
                          const Measures& measures) {
  std::vector<double> least_ms(measures.size(), -1);
  auto estimator = Estimator::create(config);
  if (!estimator) {
    fmt::print(stderr, "{}\n", estimator.error().message);
    return least_ms;
  }
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i <= options.frames || std::chrono::steady_clock::now() - start < kLeast; ++i) {
    const auto estimate = estimator->estimate(folder.frame());
    if (!estimate) {
      fmt::print(stderr, "{}\n", estimate.error().message);
      return least_ms;
    }
    for (std::size_t m = 0; i > 0 && m < measures.size(); ++m) {
      const double time_ms = measures[m](estimate->timings);
      if (i == 1 || time_ms < least_ms[m]) least_ms[m] = time_ms;
    }
  }
  return least_ms;
}

double model_ms(const Timings& timings) { return timings.model_ms; }
double outside_ms(const Timings& timings) { return timings.total_ms - timings.model_ms; }

/// Model's time over one field of Config, a line for each number of threads.
pictures::Panel model_panel(const Options& options, const FrameFolder& folder, const char* title,
                            const char* name, int Config::*field, const std::vector<int>& values) {
  pictures::Panel panel;
  panel.title = title;
  panel.x_name = name;
  panel.logarithmic = panel.logarithmic_x = values.back() > 20;
  panel.from_zero = !panel.logarithmic;
  panel.marked = true;
  for (const int threads : {1, 2}) {
    pictures::Line line{fmt::format("{} thread{}", threads, threads > 1 ? "s" : ""), {}, {}};
    for (const int value : values) {
      Config config{.weights = options.weights, .device = "cpu", .threads = threads};
      config.*field = value;
      line.x.push_back(value);
      line.y.push_back(timed(options, config, folder, {model_ms}).front());
      fmt::print("{} {}, {}: {:.1f} ms\n", name, value, line.name, line.y.back());
    }
    panel.lines.push_back(std::move(line));
  }
  return panel;
}

pictures::Panel speedup_panel(const pictures::Panel& draws) {
  pictures::Panel panel;
  panel.title = "speed-up of the model's part from 1 to 2 threads";
  panel.x_name = draws.x_name;
  panel.logarithmic_x = panel.from_zero = panel.marked = true;
  pictures::Line line{"1 thread / 2 threads", draws.lines[0].x, {}};
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    line.y.push_back(draws.lines[0].y[i] / draws.lines[1].y[i]);
  }
  panel.lines.push_back(std::move(line));
  return panel;
}

pictures::Panel mask_panel(const Options& options, const FrameFolder& folder) {
  struct Part {
    const char* name;
    std::function<double(const Timings&)> time_ms;
  };
  const std::vector<Part> parts{{"all but the model", outside_ms},
                                {"path", [](const Timings& t) { return t.path_ms; }},
                                {"prior", [](const Timings& t) { return t.prior_ms; }},
                                {"mask field", [](const Timings& t) { return t.mask_field_ms; }}};
  pictures::Panel panel;
  panel.title = "outside the model, ms, over the mask's size: 640 x 480 to 1920 x 1080";
  panel.x_name = "kilopixels";
  panel.from_zero = panel.marked = true;
  for (const Part& part : parts) panel.lines.push_back({part.name, {}, {}});
  const std::vector<std::pair<int, int>> sizes{
      {640, 480}, {960, 540}, {1280, 720}, {1600, 900}, {1920, 1080}};
  for (const auto& [width, height] : sizes) {
    const FrameFolder larger = enlarged(folder, width, height);
    const Config config{.weights = options.weights,
                        .device = "cpu",
                        .euler_steps = 1,
                        .draws = 1,
                        .max_width = width,
                        .max_height = height};
    Measures measures;
    for (const Part& part : parts) measures.push_back(part.time_ms);
    const auto times_ms = timed(options, config, larger, measures);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      panel.lines[i].x.push_back(width * height / 1000.0);
      panel.lines[i].y.push_back(times_ms[i]);
      fmt::print("{} x {}, {}: {:.1f} ms\n", width, height, parts[i].name, times_ms[i]);
    }
  }
  return panel;
}

int run(const Options& options) {
  const auto folder = load_frame_folder(options.frame);
  if (!folder) {
    fmt::print(stderr, "{}\n", folder.error().message);
    return 2;
  }
  std::vector<pictures::Panel> panels;
  panels.push_back(model_panel(options, *folder, "model's part, ms, over draws D (K = 10)", "D",
                               &Config::draws, {1, 2, 4, 8, 16, 32, 64}));
  panels.push_back(model_panel(options, *folder, "model's part, ms, over steps K (D = 4)", "K",
                               &Config::euler_steps, {1, 2, 4, 7, 10, 15, 20}));
  panels.push_back(speedup_panel(panels.front()));
  panels.push_back(mask_panel(options, *folder));
  const auto saved = pictures::save_panels(panels, options.out);
  if (!saved) fmt::print(stderr, "{}\n", saved.error().message);
  return saved ? 0 : 1;
}

}  // namespace
}  // namespace flowdlo

int main(int argc, char** argv) {
  flowdlo::Options options;
  CLI::App app("How the cost of a frame grows on the CPU back end");
  app.add_option("--weights", options.weights, "A .fdw file [the one beside the program]");
  app.add_option("--frame", options.frame, "A frame folder [the one that ships]");
  app.add_option("--out", options.out, "The picture to write")->capture_default_str();
  app.add_option("--frames", options.frames, "Calls to time, at least")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return flowdlo::run(options);
}
