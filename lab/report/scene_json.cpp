#include "report/scene_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/frame_folder.hpp"
#include "report/base64.hpp"
#include "report/jpeg.hpp"

namespace flowdlo::report {
namespace {

using nlohmann::json;

constexpr double kUnit_m = 1e-4;
constexpr int kPictureWidth = 220;
constexpr int kQuality = 70;

const std::vector<std::pair<const char*, const char*>> kColors{
    {"truth", "#2f9e44"},    {"estimate", "#3b5bdb"},      {"model", "#d9480f"},
    {"full", "#e03131"},     {"prior", "#868e96"},         {"refined", "#495057"},
    {"trackdlo", "#f08c00"}, {"geodesic", "#ae3ec9"},      {"mbest", "#0c8599"},
    {"dloftbs", "#5f3dc4"},  {"no-points", "#e599f7"},     {"direct", "#74c0fc"},
    {"residual", "#f783ac"}, {"preconditioned", "#94d82d"}};

json line_of(const Centerline& nodes) {
  json line = json::array();
  for (const Point3& node : nodes) {
    for (const float value : {node.x, node.y, node.z}) {
      line.push_back(std::llround(static_cast<double>(value) / kUnit_m));
    }
  }
  return line;
}

json curves_of(const eval::Trial& trial) {
  json curves = json::object();
  if (trial.with_truth) curves["truth"] = json::array({line_of(trial.truth)});
  if (trial.answered()) curves["estimate"] = json::array({line_of(trial.nodes)});
  for (const auto& [method, draws] : trial.curves) {
    if (draws.empty()) continue;
    json& lines = curves[method] = json::array();
    for (const Centerline& nodes : draws) lines.push_back(line_of(nodes));
  }
  return curves;
}

std::string picture_of(const eval::Trial& trial) {
  const auto folder = load_frame_folder(trial.folder);
  if (!folder || folder->color_bgr.empty()) return {};
  cv::Mat image(folder->height, folder->width, CV_8UC3);
  std::copy(folder->color_bgr.begin(), folder->color_bgr.end(), image.data);
  cv::Mat small;
  const double zoom = static_cast<double>(kPictureWidth) / folder->width;
  cv::resize(image, small, {}, zoom, zoom, cv::INTER_AREA);
  const auto bytes = encode_jpeg(small, kQuality);
  if (bytes.empty()) return {};
  return "data:image/jpeg;base64," + base64(bytes);
}

std::string text_of(const eval::Trial& trial) {
  std::string text = fmt::format("{}, {}", trial.scene.scenario, trial.scene.material);
  if (!trial.answered()) return text + "\nno estimate: " + trial.failure;
  text += fmt::format(
      "\n{} of {} draws accepted; the estimate is the {}\nconfidence {:.2f}, mask "
      "consistency {:.1f} %",
      trial.accepted_draws, trial.draws,
      trial.source == Source::kPrediction ? "model's" : "prior's", trial.confidence,
      100 * trial.mask_agreement);
  for (const char* method : {"estimate", "model", "full", "prior", "refined", "trackdlo",
                             "geodesic", "mbest", "dloftbs"}) {
    const eval::Outcome* outcome = trial.of(method);
    const eval::Account* account = trial.account(method);
    if (outcome != nullptr) {
      text += fmt::format("\n{}: {:.2f} cm", method, 100 * outcome->index_m);
    } else if (account != nullptr && !account->valid()) {
      text += fmt::format("\n{}: {}", method, account->failure);
    }
  }
  return text;
}

// "</script>" inside a string would end the element.
std::string safe(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    result += text[i] == '/' && i > 0 && text[i - 1] == '<' ? "\\/" : std::string(1, text[i]);
  }
  return result;
}

}  // namespace

std::string scenes_json(std::span<const eval::Trial> trials) {
  json page{{"unit_m", kUnit_m},
            {"sets", json::array()},
            {"colors", json::object()},
            {"order", json::array()}};
  for (const auto& [method, color] : kColors) {
    page["colors"][method] = color;
    page["order"].push_back(method);
  }
  for (const eval::DataSet& set : eval::data_sets_of(trials)) {
    json scenes = json::array();
    for (const eval::Trial* trial : set.trials) {
      json curves = curves_of(*trial);
      if (curves.empty()) continue;
      scenes.push_back({{"name", trial->name},
                        {"text", text_of(*trial)},
                        {"image", picture_of(*trial)},
                        {"curves", std::move(curves)}});
    }
    if (!scenes.empty())
      page["sets"].push_back({{"name", set.name}, {"scenes", std::move(scenes)}});
  }
  return safe(page.dump(-1, ' ', true, json::error_handler_t::replace));
}

}  // namespace flowdlo::report
