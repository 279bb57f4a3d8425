// flowdlo_ropes_report: drawn scenes of several ropes, told apart and lifted, against their truth:
// one Markdown table by kind and one by number; --overlays draws the scenes that are not right.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/device_choice.hpp"
#include "field/network.hpp"
#include "ropes_report/ropes_outcome.hpp"
#include "scene/setting.hpp"

namespace {

using flowdlo::lab::RopesKind;
using flowdlo::lab::RopesOutcome;
using flowdlo::lab::RopesScene;

struct Options {
  int scenes = 10;
  std::uint64_t first = 0;
  int least = 2;
  int most = 5;
  std::string kind;
  bool labels = false;
  bool counted = false;
  std::string weights;
  std::string field;
  std::string overlays;
  bool all = false;
};

flowdlo::Result<flowdlo::field::Network> network_of(const std::string& file) {
  auto loaded = flowdlo::weights::load_field(file);
  if (!loaded) return loaded.error();
  return flowdlo::field::Network::create(
      std::make_shared<const flowdlo::weights::FieldWeights>(*std::move(loaded)),
      flowdlo::estimator::cpu_back_end(1).make_program);
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(at, values.size() - 1)];
}

struct Tally {
  int scenes = 0;
  int all_right = 0;
  int count_right = 0;
  int ropes = 0;
  int right = 0;
  int crossings = 0;
  int found = 0;
  int order_right = 0;
  int trusted = 0;  // confidence of a half at least, of the right
  int doubted = 0;  // below, of the wrong
  int wrong = 0;
  std::vector<double> index_cm, total_ms, field_ms;
  std::vector<std::pair<double, bool>> confidences;  // of each rope found, and whether it is right

  void add(const RopesScene& scene, const RopesOutcome& outcome) {
    ++scenes;
    all_right += outcome.all_right ? 1 : 0;
    count_right += outcome.found == static_cast<int>(scene.ropes.size()) ? 1 : 0;
    ropes += static_cast<int>(scene.ropes.size());
    right += outcome.right;
    crossings += outcome.crossings;
    found += outcome.crossings_found;
    order_right += outcome.crossings_right;
    for (std::size_t i = 0; i < outcome.confidence.size(); ++i) {
      const bool sure = outcome.confidence[i] >= 0.5;
      confidences.emplace_back(outcome.confidence[i], outcome.rope_right[i]);
      if (outcome.rope_right[i]) {
        trusted += sure ? 1 : 0;
      } else {
        ++wrong;
        doubted += sure ? 0 : 1;
      }
    }
    index_cm.insert(index_cm.end(), outcome.index_cm.begin(), outcome.index_cm.end());
    total_ms.push_back(outcome.total_ms);
    if (outcome.axes) field_ms.push_back(outcome.field_ms);
  }

  // How often ropes of a confidence are right.
  void print_calibration() const {
    constexpr std::array kBounds{0.0, 0.25, 0.5, 0.75, 0.9, 0.97, 1.0};
    std::printf("\n| confidence | ropes | mean confidence | right |\n|---|---|---|---|\n");
    for (std::size_t b = 0; b + 1 < kBounds.size(); ++b) {
      int ropes = 0;
      int correct = 0;
      double sum = 0;
      for (const auto& [confidence, good] : confidences) {
        const bool last = b + 2 == kBounds.size();
        if (confidence < kBounds[b] || (confidence >= kBounds[b + 1] && !last)) continue;
        ++ropes;
        correct += good ? 1 : 0;
        sum += confidence;
      }
      const int most = std::max(1, ropes);
      std::printf("| %.2f to %.2f | %d | %.3f | %.1f %% |\n", kBounds[b], kBounds[b + 1], ropes,
                  sum / most, 100.0 * correct / most);
    }
    if (field_ms.empty()) return;
    std::printf("\nms of the strand field: median %.0f, 95 %% %.0f\n", percentile(field_ms, 0.5),
                percentile(field_ms, 0.95));
  }

  void print(const std::string& name) const {
    double sum = 0;
    for (const double value : index_cm) sum += value;
    std::printf(
        "| %s | %d | %d | %.1f %% | %d of %d | %.3f / %.3f / %.3f | %d of %d of %d | %.1f %% | "
        "%d of %d | %.0f |\n",
        name.c_str(), scenes, count_right, 100.0 * all_right / std::max(1, scenes), right, ropes,
        sum / static_cast<double>(std::max<std::size_t>(1, index_cm.size())),
        percentile(index_cm, 0.5), percentile(index_cm, 0.95), order_right, found, crossings,
        100.0 * trusted / std::max(1, right), doubted, wrong, percentile(total_ms, 0.5));
    std::fflush(stdout);
  }
};

bool draw(const std::string& file, const RopesScene& scene, const RopesOutcome& outcome) {
  static const std::array<cv::Scalar, 9> kColors{
      cv::Scalar(196, 212, 32), {0, 140, 255},  {255, 110, 60},  {60, 220, 60},  {220, 80, 220},
      {40, 220, 240},           {250, 230, 90}, {120, 120, 255}, {160, 160, 160}};
  const auto& image = scene.image;
  cv::Mat picture =
      cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.color_bgr.data()))
          .clone();
  picture *= 0.5;
  const cv::Mat mask(image.height, image.width, CV_8U,
                     const_cast<std::uint8_t*>(image.mask.data()));
  picture.setTo(cv::Scalar(90, 90, 90), mask > 127);
  for (int v = 0; v < image.height && !outcome.instances.empty(); ++v) {
    for (int u = 0; u < image.width; ++u) {
      const auto label = outcome.instances[static_cast<std::size_t>(v) * image.width + u];
      if (label == 0) continue;
      const auto& color = kColors[(label - 1U) % kColors.size()];
      for (int c = 0; c < 3; ++c) {
        picture.at<cv::Vec3b>(v, u)[c] = static_cast<std::uint8_t>(30 + 0.4 * color[c]);
      }
    }
  }
  for (std::size_t l = 0; outcome.axes && l < outcome.axes->lines.size(); ++l) {
    std::vector<cv::Point> points;
    for (const auto& p : outcome.axes->lines[l].points_px) {
      points.emplace_back(static_cast<int>(p.x() * 16), static_cast<int>(p.y() * 16));
    }
    for (const cv::Point& end : {points.front(), points.back()}) {
      cv::circle(picture, end, 2 * 16, {255, 255, 255}, -1, cv::LINE_AA, 4);
    }
    cv::polylines(picture, points, outcome.axes->lines[l].closed, {255, 255, 255}, 1, cv::LINE_AA,
                  4);
  }
  for (std::size_t i = 0; i < outcome.ropes.size(); ++i) {
    std::vector<cv::Point> points;
    for (const auto& p : outcome.ropes[i].nodes) {
      const auto q = flowdlo::lab::project(image.camera, {p.x, p.y, p.z});
      points.emplace_back(static_cast<int>(q.x() * 16), static_cast<int>(q.y() * 16));
    }
    const auto& color = kColors[i % kColors.size()];
    cv::polylines(picture, points, outcome.ropes[i].closed, color, 2, cv::LINE_AA, 4);
    cv::circle(picture, points.front(), 5 * 16, color, 2, cv::LINE_AA, 4);
    cv::circle(picture, points.back(), 5 * 16, color, 2, cv::LINE_AA, 4);
  }
  return cv::imwrite(file, picture);
}

int report(const Options& options) {
  std::optional<flowdlo::Estimator> model;
  std::optional<flowdlo::field::Network> network;
  if (!options.field.empty() && options.weights.empty()) {
    auto opened = network_of(options.field);
    if (!opened) {
      std::fprintf(stderr, "%s\n", opened.error().message.c_str());
      return 2;
    }
    network = *std::move(opened);
  }
  std::map<int, Tally> by_number;
  std::map<int, Tally> by_kind;
  Tally total;
  for (int k = 0; k < flowdlo::lab::kRopesKinds; ++k) {
    const auto kind = static_cast<RopesKind>(k);
    if (!options.kind.empty() && name_of(kind) != options.kind) continue;
    for (int ropes = options.least; ropes <= options.most; ++ropes) {
      const int wanted = options.counted ? ropes : 0;
      if (!options.weights.empty() && (!model || options.counted)) {
        flowdlo::Config config;
        config.weights = options.weights;
        config.device = "cpu";
        config.ropes = wanted;
        config.field_weights = options.field;
        if (options.field.empty()) config.field = flowdlo::FieldChoice::kOff;
        auto made = flowdlo::Estimator::create(config);
        if (!made) {
          std::fprintf(stderr, "%s\n", made.error().message.c_str());
          return 2;
        }
        model = *std::move(made);
      }
      for (int i = 0; i < options.scenes; ++i) {
        const std::uint64_t seed = options.first + static_cast<std::uint64_t>(i);
        const auto scene = flowdlo::lab::make_ropes(kind, ropes, seed);
        const auto outcome = flowdlo::lab::outcome_of(
            scene,
            {wanted, options.labels, model ? &*model : nullptr, network ? &*network : nullptr});
        for (Tally* tally : {&by_number[ropes], &by_kind[k], &total}) tally->add(scene, outcome);
        const std::string name =
            std::string(name_of(kind)) + "_" + std::to_string(ropes) + "_" + std::to_string(seed);
        if (!outcome.all_right) {
          std::fprintf(stderr, "  %s: %d of %d ropes right, %d found %s\n", name.c_str(),
                       outcome.right, ropes, outcome.found, outcome.error.c_str());
        }
        if (options.overlays.empty() || (outcome.all_right && !options.all)) continue;
        const std::string file = options.overlays + "/" + name + ".png";
        if (!draw(file, scene, outcome)) {
          std::fprintf(stderr, "%s: cannot be written; name an existing folder\n", file.c_str());
          return 1;
        }
      }
    }
  }
  std::printf(
      "index error of the right ropes in cm: mean / median / 95 %%; crossings of right ropes: "
      "right "
      "one above, told of, true ones\n"
      "| scenes of | scenes | right number | wholly right | ropes right | index error | crossings |"
      " confidence >= 0.5, of the right | < 0.5, of the wrong | ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [k, tally] : by_kind) {
    tally.print(std::string(name_of(static_cast<RopesKind>(k))));
  }
  for (const auto& [ropes, tally] : by_number) tally.print(std::to_string(ropes) + " ropes");
  total.print("all");
  total.print_calibration();
  return 0;
}

}  // namespace

int main(int count, char** values) {
  Options options;
  CLI::App app{"Several ropes in one frame, on drawn scenes, against their truth"};
  app.add_option("--scenes", options.scenes, "Of each kind and number")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--first", options.first, "Seed of the first scene of each")
      ->capture_default_str();
  app.add_option("--least", options.least, "Fewest ropes of a scene")
      ->capture_default_str()
      ->check(CLI::Range(2, 9));
  app.add_option("--most", options.most, "Most ropes of a scene")
      ->capture_default_str()
      ->check(CLI::Range(2, 9));
  app.add_option("--kind", options.kind, "Of this kind only")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return flowdlo::lab::ropes_kind_of(name) ? std::string() : "no kind of scene: " + name;
          },
          "KIND"));
  app.add_flag("--labels", options.labels, "Frame::instances are given");
  app.add_flag("--counted", options.counted, "The number of ropes is given");
  app.add_option("--weights", options.weights, "The whole estimator with this model [priors alone]")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option("--field", options.field,
                 "Tell them apart by this strand field as well [the mask alone]")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option("--overlays", options.overlays, "Draw the scenes that are not right into DIR")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  app.add_flag("--all", options.all, "Draw those that are right as well");
  CLI11_PARSE(app, count, values);
  return report(options);
}
