#include "eval/figures.hpp"

#include "eval/drawn_figures.hpp"

namespace flowdlo::eval {
namespace {

struct Kind {
  const char* name;
  const char* title;
  Png (*draw)(const DataSet& data_set);
};

constexpr Kind kKinds[] = {
    {"paired_bars", "Figure 4.2: paired errors by scenario", paired_bars_png},
    {"overlays", "Figure 4.4: overlays on real frames", real_overlay_png},
    {"steps", "Table 4.5 as a plot: index error over the steps", sweep_plot_png},
    {"reliability", "Reliability of the confidence", reliability_png}};

}  // namespace

Result<std::vector<Figure>> figures(std::span<const Trial> trials) {
  std::vector<Figure> all;
  for (const DataSet& set : data_sets_of(trials)) {
    for (const Kind& kind : kKinds) {
      auto png = kind.draw(set);
      if (!png) return png.error();
      if (png->empty()) continue;
      all.push_back({set.name + "_" + kind.name, std::string(kind.title) + " (" + set.name + ")",
                     *std::move(png)});
    }
  }
  return all;
}

}  // namespace flowdlo::eval
