#include "eval/example_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "eval/space_view.hpp"
#include "pictures/canvas.hpp"

namespace flowdlo::eval {
namespace {

struct Choice {
  const char* scenario;
  int third;  // 1, 2: how many thirds through the group
};
constexpr std::array<Choice, 6> kThesisChoice{{{"intersection", 1},
                                               {"intersection", 2},
                                               {"C-complicated", 1},
                                               {"intersection-complicated", 1},
                                               {"intersection-complicated", 2},
                                               {"S-complicated", 1}}};
constexpr int kWidth = 420;
constexpr int kHeight = 260;
constexpr int kTop = 60;

struct Panel {
  std::string title;
  std::vector<std::pair<std::string, cv::Scalar>> methods;  // every draw of each
};

std::vector<Panel> panels_of(const DataSet& data_set) {
  std::vector<Panel> panels;
  const auto has = [&](const std::string& name) {
    return std::any_of(data_set.trials.begin(), data_set.trials.end(), [&](const Trial* trial) {
      return trial->curves.find(name) != trial->curves.end();
    });
  };
  if (has("full")) panels.push_back({"full model, every draw", {{"full", {}}}});
  panels.push_back({"evaluated model's draws and our estimate",
                    {{"model", {}}, {"", pictures::kEstimateColor}}});
  if (has("trackdlo"))
    panels.push_back({"TrackDLO-init", {{"trackdlo", pictures::kBaselineColor}}});
  return panels;
}

std::string error_text(const Trial& trial, const std::string& method) {
  const Outcome* outcome = trial.of(method);
  return outcome == nullptr ? "no valid output" : fmt::format("{:.2f} cm", 100 * outcome->index_m);
}

void draw_panel(const Trial& trial, const Panel& panel, const cv::Rect& place,
                pictures::Canvas& canvas) {
  cv::Mat view = canvas.panel(place);
  const SpaceView space(trial.truth, place.size());
  space.draw(trial.truth, pictures::kTruthColor, 3, view);
  std::string text;
  for (const auto& [method, color] : panel.methods) {
    if (method.empty()) {
      if (trial.answered()) space.draw(trial.nodes, color, 1, view);
      text += (text.empty() ? "estimate " : "  estimate ") + error_text(trial, "estimate");
      continue;
    }
    text += (text.empty() ? "" : "  ") + method + " " + error_text(trial, method);
    const auto found = trial.curves.find(method);
    if (found == trial.curves.end()) continue;
    for (std::size_t d = 0; d < found->second.size(); ++d) {
      space.draw(found->second[d], color == cv::Scalar() ? pictures::draw_color(d) : color, 1,
                 view);
    }
  }
  canvas.write_over(text, {place.x + 4, place.y + place.height - 6}, 0.36);
  cv::rectangle(canvas.picture(), place, {225, 225, 225});
}

}  // namespace

std::vector<const Trial*> fixed_examples(const DataSet& data_set) {
  std::vector<const Trial*> examples;
  const auto groups = groups_of(data_set);
  if (data_set.thesis_groups) {
    for (const Choice& choice : kThesisChoice) {
      for (const SceneGroup& group : groups) {
        if (group.name != choice.scenario) continue;
        const auto at = group.trials.size() * static_cast<std::size_t>(choice.third) / 3;
        const Trial* trial = group.trials[std::min(at, group.trials.size() - 1)];
        if (std::find(examples.begin(), examples.end(), trial) == examples.end()) {
          examples.push_back(trial);
        }
      }
    }
  }
  if (!examples.empty()) return examples;
  for (const SceneGroup& group : groups) {
    if (group.name == "all" || examples.size() == kThesisChoice.size()) continue;
    examples.push_back(group.trials[group.trials.size() / 2]);
  }
  return examples;
}

Result<std::vector<std::uint8_t>> example_sheet_png(const DataSet& data_set) {
  const auto examples = fixed_examples(data_set);
  if (examples.empty()) return std::vector<std::uint8_t>();
  const auto panels = panels_of(data_set);
  pictures::Canvas canvas(20 + (kWidth + 10) * static_cast<int>(panels.size()),
                          kTop + (kHeight + 26) * static_cast<int>(examples.size()) + 10);
  canvas.legend(pictures::legend_of_draws("truth", pictures::kTruthColor), {10, 24});
  int y = kTop;
  for (const Trial* trial : examples) {
    canvas.write(trial->name + "; index errors, rings at the first nodes", {10, y + 14});
    int x = 10;
    for (const Panel& panel : panels) {
      if (trial == examples.front()) canvas.write(panel.title, {x, kTop - 8}, 0.45);
      draw_panel(*trial, panel, {x, y + 20, kWidth, kHeight}, canvas);
      x += kWidth + 10;
    }
    y += kHeight + 26;
  }
  return canvas.png();
}

}  // namespace flowdlo::eval
