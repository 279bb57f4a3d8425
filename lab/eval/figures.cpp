#include "eval/figures.hpp"

#include "eval/example_sheet.hpp"
#include "eval/paired_bars.hpp"
#include "eval/real_overlay.hpp"
#include "eval/reliability_plot.hpp"
#include "eval/sweep_sheet.hpp"

namespace flowdlo::eval {
namespace {

using Draw = Result<std::vector<std::uint8_t>> (*)(const DataSet& data_set);

struct Kind {
  const char* name;
  const char* title;
  Draw draw;
};

constexpr Kind kKinds[] = {
    {"paired_bars", "Figure 4.2: paired errors by scenario", paired_bars_png},
    {"examples", "Figure 4.3: fixed examples with every draw", example_sheet_png},
    {"overlays", "Figure 4.4: overlays on real frames", real_overlay_png},
    {"steps", "Table 4.5 as a plot: index error over the steps", sweep_plot_png},
    {"time_sweep", "Figure 4.5: what more steps change", sweep_sheet_png},
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
