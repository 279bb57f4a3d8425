// flowdlo-lab ropes-report: drawn or rendered scenes of several ropes, told apart and lifted,
// against their truth: one Markdown table by kind and one by number; --overlays draws the scenes
// that are not right.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "geometry/depth.hpp"
#include "mat/mat_file.hpp"
#include "reports/rendered_ropes.hpp"
#include "reports/rope_odds.hpp"
#include "reports/ropes_outcome.hpp"
#include "scene/setting.hpp"
#include "strand/scene_range.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::lab {
namespace {

struct Options {
  int scenes = 10;
  std::uint64_t first = 0;
  int least = 2;
  int most = 5;
  std::string kind;
  std::string rendered = "training";
  std::vector<std::string> rendered_splits{"several"};
  int rendered_scenes = 0;
  std::uint64_t rendered_first = 0;
  bool labels = false;
  bool counted = false;
  bool photograph = false;
  bool cords = false;
  std::string weights;
  std::string field;
  std::string overlays;
  bool odds = false;
  bool all = false;
};

struct Tally {
  int scenes = 0;
  int all_right = 0;
  int count_right = 0;
  int ropes = 0;
  int right = 0;
  int crossings = 0;
  int found = 0;
  int order_right = 0;
  survey::Values index_cm, total_ms, field_ms;
  std::vector<std::pair<double, bool>> confidences;  // of each rope found, and whether it is close
  RopeOdds odds;

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
      confidences.emplace_back(outcome.confidence[i], outcome.rope_close[i]);
    }
    odds.add(outcome);
    index_cm.add(survey::Values(outcome.index_cm));
    total_ms.add(outcome.total_ms);
    if (outcome.axes) field_ms.add(outcome.field_ms);
  }

  // [0, 1] share of the close or other ropes that have a confidence of a half.
  [[nodiscard]] double trusted(bool close) const {
    survey::Values sure;
    for (const auto& [confidence, is_close] : confidences) {
      if (is_close == close) sure.add(confidence >= 0.5 ? 1 : 0);
    }
    return sure.mean();
  }

  // How often ropes of a confidence are close.
  void print_calibration() const {
    constexpr std::array kBounds{0.0, 0.25, 0.5, 0.75, 0.9, 0.97, 1.0};
    survey::Table bins({"confidence", "ropes", "mean confidence", "right and less than 1 cm off"});
    double off = 0;
    for (std::size_t b = 0; b + 1 < kBounds.size(); ++b) {
      survey::Values said;
      survey::Values correct;
      for (const auto& [confidence, close] : confidences) {
        const bool last = b + 2 == kBounds.size();
        if (confidence < kBounds[b] || (confidence >= kBounds[b + 1] && !last)) continue;
        said.add(confidence);
        correct.add(close ? 1 : 0);
      }
      if (said.count() == 0) continue;
      off += static_cast<double>(said.count()) * std::abs(said.mean() - correct.mean());
      bins.add({fmt::format("{:.2f} to {:.2f}", kBounds[b], kBounds[b + 1]),
                std::to_string(said.count()), fmt::format("{:.3f}", said.mean()),
                fmt::format("{:.1f} %", 100 * correct.mean())});
    }
    if (!confidences.empty()) {
      fmt::print(
          "{}mean distance between both, a rope: {:.3f}; of the close ropes {:.1f} % have a "
          "confidence of 0.5 at least, of the others {:.1f} %\n",
          bins.text(), off / static_cast<double>(confidences.size()), 100 * trusted(true),
          100 * trusted(false));
    }
    odds.print();
    if (field_ms.count() == 0) return;
    fmt::print("ms of the strand field: median {:.0f}, 95 % {:.0f}\n", field_ms.median(),
               field_ms.quantile(0.95));
  }

  void add_row(const std::string& name, survey::Table& table) const {
    table.add({name, std::to_string(scenes), std::to_string(count_right),
               fmt::format("{:.1f} %", survey::percent(all_right, scenes)),
               fmt::format("{} of {}", right, ropes),
               fmt::format("{:.3f} / {:.3f} / {:.3f}", index_cm.mean(), index_cm.median(),
                           index_cm.quantile(0.95)),
               fmt::format("{} of {} of {}", order_right, found, crossings),
               fmt::format("{:.0f}", total_ms.median())});
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
      const auto q = project(image.camera, {p.x, p.y, p.z});
      points.emplace_back(static_cast<int>(q.x() * 16), static_cast<int>(q.y() * 16));
    }
    const auto& color = kColors[i % kColors.size()];
    cv::polylines(picture, points, outcome.ropes[i].closed, color, 2, cv::LINE_AA, 4);
    cv::circle(picture, points.front(), 5 * 16, color, 2, cv::LINE_AA, 4);
    cv::circle(picture, points.back(), 5 * 16, color, 2, cv::LINE_AA, 4);
  }
  return mat::save_png(file, picture).has_value();
}

// As who has a photograph alone makes a frame of it: one depth everywhere, that of the ropes.
void flatten(RopesScene& scene) {
  survey::Values depths_m;
  for (std::size_t p = 0; p < scene.image.mask.size(); ++p) {
    const float z = scene.image.depth_m[p];
    if (scene.image.mask[p] > 127 && geometry::measured(z)) depths_m.add(static_cast<double>(z));
  }
  if (depths_m.count() == 0) return;
  std::fill(scene.image.depth_m.begin(), scene.image.depth_m.end(),
            static_cast<float>(depths_m.median()));
}

// What tells ropes apart and estimates them, for as many ropes as are wanted.
class Answers {
 public:
  explicit Answers(const Options& options) : options_(options) {}

  Result<RopesOutcome> of(const RopesScene& scene, int wanted) {
    if (!options_.weights.empty() && (!model_ || wanted != made_for_)) {
      auto made = Estimator::create(config(wanted));
      if (!made) return made.error();
      model_ = *std::move(made);
      made_for_ = wanted;
    }
    const bool by_parts = options_.weights.empty() || options_.odds;
    if (!options_.field.empty() && by_parts && !network_) {
      auto opened = strand::one_network(options_.field);
      if (!opened) return opened.error();
      network_ = *std::move(opened);
    }
    if (options_.odds && !judge_) {
      auto opened = open_judge(config(wanted));
      if (!opened) return opened.error();
      judge_ = *std::move(opened);
    }
    return outcome_of(scene, {wanted, options_.labels, model_ ? &*model_ : nullptr,
                              network_ ? &*network_ : nullptr, judge_ ? &*judge_ : nullptr});
  }

 private:
  [[nodiscard]] Config config(int wanted) const {
    Config config;
    config.weights = options_.weights;
    config.device = "cpu";
    config.ropes = wanted;
    config.field_weights = options_.field;
    if (options_.field.empty()) config.field = FieldChoice::kOff;
    return config;
  }

  const Options& options_;
  std::optional<Estimator> model_;
  int made_for_ = 0;
  std::optional<field::Network> network_;
  std::optional<RopeJudge> judge_;
};

// All scenes of a run and what came of them.
class Report {
 public:
  explicit Report(const Options& options) : options_(options), answers_(options) {}

  // `name` also names the picture.
  Result<void> add(RopesScene scene, const std::string& kind, const std::string& name) {
    if (options_.photograph) flatten(scene);
    const auto ropes = static_cast<int>(scene.ropes.size());
    const auto outcome = answers_.of(scene, options_.counted ? ropes : 0);
    if (!outcome) return outcome.error();
    for (Tally* tally : {&by_number_[ropes], &by_kind_[kind], &total_}) tally->add(scene, *outcome);
    if (!outcome->all_right) {
      fmt::print(stderr, "  {}: {} of {} ropes right, {} found {}\n", name, outcome->right, ropes,
                 outcome->found, outcome->error);
    }
    if (options_.overlays.empty() || (outcome->all_right && !options_.all)) return {};
    const std::string file = options_.overlays + "/" + name + ".png";
    if (draw(file, scene, *outcome)) return {};
    return Error{ErrorCode::kIo, file + ": cannot be written; name an existing folder"};
  }

  void print() const {
    survey::Table table({"scenes of", "scenes", "right number", "wholly right", "ropes right",
                         "index error", "crossings", "ms"});
    for (const auto& [kind, tally] : by_kind_) tally.add_row(kind, table);
    for (const auto& [ropes, tally] : by_number_) {
      tally.add_row(std::to_string(ropes) + " ropes", table);
    }
    total_.add_row("all", table);
    fmt::print(
        "index error of the right ropes in cm: mean / median / 95 %; crossings of right ropes: "
        "right one above, told of, true ones\n{}",
        table.text());
    total_.print_calibration();
  }

 private:
  const Options& options_;
  Answers answers_;
  std::map<int, Tally> by_number_;
  std::map<std::string, Tally> by_kind_;
  Tally total_;
};

Result<void> add_drawn(const Options& options, Report& report) {
  for (int k = 0; k < kRopesKinds; ++k) {
    const auto kind = static_cast<RopesKind>(k);
    const std::string name(name_of(kind));
    if (!options.kind.empty() && name != options.kind) continue;
    for (int ropes = options.least; ropes <= options.most; ++ropes) {
      for (int i = 0; i < options.scenes; ++i) {
        const std::uint64_t seed = options.first + static_cast<std::uint64_t>(i);
        const auto added =
            report.add(make_ropes(kind, ropes, seed), name,
                       name + "_" + std::to_string(ropes) + "_" + std::to_string(seed));
        if (!added) return added;
      }
    }
  }
  return {};
}

Result<void> add_rendered(const Options& options, synth::Split split, Report& report) {
  const bool one = split == synth::Split::kWide;
  int passed_over = 0;
  for (int i = 0; i < options.rendered_scenes; ++i) {
    const std::uint64_t index = options.rendered_first + static_cast<std::uint64_t>(i);
    const auto made =
        rendered_ropes(split, *synth::part_of(options.rendered), index, options.cords);
    if (!made) return made.error();
    if (!*made) {
      ++passed_over;
      continue;
    }
    const auto& [scenario, scene] = **made;
    const auto ropes = static_cast<int>(scene.ropes.size());
    if (!one && (ropes < options.least || ropes > options.most)) continue;
    if (!options.kind.empty() && scenario != options.kind) continue;
    const auto added = report.add(scene, scenario, scenario + "_" + std::to_string(index));
    if (!added) return added;
  }
  if (options.rendered_scenes == 0) return {};
  fmt::print(stderr, "passed over, since a rope leaves the image and comes back: {}\n",
             passed_over);
  return {};
}

int run(const Options& options) {
  if (options.odds && options.weights.empty()) {
    fmt::print(stderr, "ropes-report --odds: expected --weights FILE, got none; give both\n");
    return 2;
  }
  Report report(options);
  auto done = add_drawn(options, report);
  for (const std::string& name : options.rendered_splits) {
    if (done) done = add_rendered(options, *synth::split_of(name), report);
  }
  if (!done) {
    fmt::print(stderr, "{}\n", done.error().message);
    return 2;
  }
  report.print();
  return 0;
}

}  // namespace

void add_ropes_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "ropes-report", "Several ropes in one frame, on drawn scenes, against their truth");
  app.add_option("--scenes", options->scenes, "Drawn ones, of each kind and number")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000));
  app.add_option("--first", options->first, "Seed of the first drawn scene of each")
      ->capture_default_str();
  app.add_option("--least", options->least, "Fewest ropes of a scene")
      ->capture_default_str()
      ->check(CLI::Range(2, 9));
  app.add_option("--most", options->most, "Most ropes of a scene")
      ->capture_default_str()
      ->check(CLI::Range(2, 9));
  app.add_option("--kind", options->kind, "Of this kind, or rendered scenario, only")
      ->check(CLI::Validator(
          [](const std::string& name) {
            const auto rendered = [&](synth::Split split) {
              const auto names = synth::scenarios(split);
              return std::find(names.begin(), names.end(), name) != names.end();
            };
            const bool known = ropes_kind_of(name) || rendered(synth::Split::kSeveral) ||
                               rendered(synth::Split::kTangled);
            return known ? std::string() : "no kind of scene: " + name;
          },
          "KIND"));
  app.add_option("--rendered", options->rendered,
                 "Part of flowdlo synth's split that rendered scenes come from")
      ->capture_default_str()
      ->check(CLI::IsMember({"training", "validation"}))
      ->type_name("PART");
  app.add_option(
         "--rendered-split", options->rendered_splits,
         "several, tangled, or wide: one rope each, whatever --least and --most say; or some "
         "of them, so many scenes of each")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::IsMember({"several", "tangled", "wide"}))
      ->type_name("SPLIT");
  app.add_option("--rendered-scenes", options->rendered_scenes, "How many of them")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000));
  app.add_option("--rendered-first", options->rendered_first, "Index of the first of them")
      ->capture_default_str();
  app.add_flag("--labels", options->labels, "Frame::instances are given");
  app.add_flag("--counted", options->counted, "The number of ropes is given");
  app.add_flag("--cords", options->cords,
               "Rendered ropes are laid of strands, speckled, striped or banded, in any colours");
  app.add_flag("--photograph", options->photograph,
               "One depth everywhere, as who has a photograph alone makes a frame of it");
  app.add_option("--weights", options->weights,
                 "The whole estimator with this model [priors alone]")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option("--field", options->field,
                 "Tell them apart by this strand field as well [the mask alone]")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option("--overlays", options->overlays, "Draw the scenes that are not right into DIR")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  app.add_flag("--odds", options->odds,
               "With --weights: fit how sure each rope's estimate is to what tells of it");
  app.add_flag("--all", options->all, "Draw those that are right as well");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
