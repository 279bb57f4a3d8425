// flowdlo-lab reading-report: the centerline that comes of the mask as given, and of a strand
// field, before any model or gate, on `wide` scenes with truth.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "estimator/conditions.hpp"
#include "estimator/confidence.hpp"
#include "estimator/judge.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "field/axes.hpp"
#include "field/channel.hpp"
#include "field/strand_field.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "mat/mat_file.hpp"
#include "mat/mat_image.hpp"
#include "path/strand_reading.hpp"
#include "strand/measure.hpp"
#include "strand/patch.hpp"
#include "strand/scene_range.hpp"

namespace {

namespace estimator = flowdlo::estimator;
namespace field = flowdlo::field;
namespace synth = flowdlo::synth;

struct Options {
  flowdlo::strand::SceneRange range;
  double list_over_cm = 1e9;
  std::filesystem::path pictures;
};

/// Errors in centimetres, and what took how long.
struct Outcome {
  std::uint64_t index = 0;
  std::string scenario;
  bool clear = false;
  double mask_cm = 0;      // best hypothesis of the mask
  double field_cm = 0;     // of the field
  double closer_cm = 0;    // of a closer look through it
  double scored_cm = 0;    // the one of both with the higher score
  double best_cm = 0;      // the nearest of all
  double of_field_cm = 0;  // nearest of both looks
  double mask_ms = 0;
  double field_ms = 0;
  double path_ms = 0;
};

double error_cm(const flowdlo::Centerline& nodes, const flowdlo::Centerline& truth) {
  return 100 * flowdlo::eval::score(nodes, truth).either_index_m;
}

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// What the field shows, nearness to axes red, tips green, strands below blue; the lines that are
/// followed in it, in colours that change; the truth, dotted in white; and the best path, thin,
/// from blue to yellow.
void draw(const std::filesystem::path& file, const field::StrandField& seen,
          const flowdlo::path::Path& path, const flowdlo::Centerline& truth,
          const flowdlo::Intrinsics& camera) {
  constexpr float kTimes = 2;
  cv::Mat picture(flowdlo::mat::size_of(seen.channels.size()), CV_8UC3);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const auto& at = seen.channels.at(v, u);
      const auto byte = [](float value) { return cv::saturate_cast<std::uint8_t>(120 * value); };
      picture.at<cv::Vec3b>(v, u) = {byte(at[field::kUnder]), byte(at[field::kTip]),
                                     byte(at[field::kCentre])};
    }
  }
  cv::resize(picture, picture, picture.size() * static_cast<int>(kTimes), 0, 0, cv::INTER_NEAREST);
  const auto place = [](const Eigen::Vector2f& p) {
    return cv::Point(static_cast<int>(std::lround(kTimes * (p.x() + 0.5F) - 0.5F)),
                     static_cast<int>(std::lround(kTimes * (p.y() + 0.5F) - 0.5F)));
  };
  int number = 0;
  for (const field::AxisLine& line : field::axis_lines(seen.channels)) {
    const cv::Scalar color(120 + 120 * (number % 2), 80 + 85 * (number % 3),
                           60 + 60 * (number % 4));
    ++number;
    for (std::size_t i = 1; i < line.points_px.size(); ++i) {
      cv::line(picture, place(line.points_px[i - 1]), place(line.points_px[i]), color, 2);
    }
    cv::circle(picture, place(line.points_px.front()), 4, color, 1);
    cv::circle(picture, place(line.points_px.back()), 4, color, 1);
  }
  std::vector<Eigen::Vector2f> nodes;
  for (const flowdlo::Point3& node : truth) {
    nodes.push_back(flowdlo::geometry::project(camera, node));
  }
  for (const Eigen::Vector2f& p : flowdlo::geometry::resample(nodes, 400)) {
    cv::circle(picture, place(seen.region.to_region(p)), 1, cv::Scalar::all(255), cv::FILLED);
  }
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(path.points_px.size());
    cv::line(picture, place(seen.region.to_region(path.points_px[i - 1])),
             place(seen.region.to_region(path.points_px[i])),
             cv::Scalar(255 * (1 - t), 255 * t, 255 * t), 1);
  }
  if (const auto saved = flowdlo::mat::save_png(file, picture); !saved) {
    fmt::print(stderr, "{}\n", saved.error().message);
  }
}

/// Best first; none where there are no paths or nothing can be made of them.
std::vector<estimator::Hypothesis> lifted(const flowdlo::Result<flowdlo::path::Traversals>& paths,
                                          const estimator::Conditions& conditions,
                                          const flowdlo::Frame& frame) {
  if (!paths) return {};
  auto hypotheses = estimator::lift_all(*paths, conditions.cloud, conditions.visible, frame,
                                        flowdlo::weights::PriorKind::kRefined);
  return hypotheses ? *std::move(hypotheses) : std::vector<estimator::Hypothesis>();
}

flowdlo::Result<Outcome> measure(const Options& options, std::uint64_t index,
                                 field::Network& network) {
  const auto part = *synth::part_of(options.range.part);
  auto scene = synth::make_frame(synth::Split::kWide, part, 0, index, synth::Render{});
  if (!scene) return scene.error();
  const flowdlo::Frame frame = scene->frame();
  const auto truth = scene->truth();
  Outcome outcome;
  outcome.index = index;
  outcome.scenario = scene->meta.scenario;
  flowdlo::Timings timings;
  auto begin = std::chrono::steady_clock::now();
  const auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) return conditions.error();
  outcome.mask_ms = ms_since(begin);
  const auto& of_mask = conditions->hypotheses;
  outcome.clear = estimator::confidence(of_mask.front().evidence, estimator::lead(of_mask)) >=
                  estimator::kClear;
  begin = std::chrono::steady_clock::now();
  const auto glance = flowdlo::path::glance(frame);
  if (!glance) return glance.error();
  const auto seen = field::see(frame, glance->rope_width_px, network);
  if (!seen) return seen.error();
  outcome.field_ms = ms_since(begin);
  begin = std::chrono::steady_clock::now();
  const auto axes = field::axes(*seen);
  const auto paths = flowdlo::path::trace_strands(frame, axes);
  const auto of_field = lifted(paths, *conditions, frame);
  outcome.path_ms = ms_since(begin);
  const auto nearer = field::see(frame, estimator::kCloser * axes.width_px, network);
  const auto of_closer =
      nearer ? lifted(flowdlo::path::trace_strands(frame, field::axes(*nearer)), *conditions, frame)
             : std::vector<estimator::Hypothesis>();
  if (paths && !options.pictures.empty()) {
    draw(options.pictures / fmt::format("{}_{}.png", index, outcome.scenario), *seen,
         paths->ranked.front(), truth, frame.intrinsics);
  }
  outcome.mask_cm = error_cm(of_mask.front().prior.nodes, truth);
  outcome.field_cm = of_field.empty() ? 99 : error_cm(of_field.front().prior.nodes, truth);
  outcome.closer_cm = of_closer.empty() ? 99 : error_cm(of_closer.front().prior.nodes, truth);
  const bool by_field = !of_field.empty() && of_field.front().score > of_mask.front().score;
  outcome.scored_cm = by_field ? outcome.field_cm : outcome.mask_cm;
  outcome.of_field_cm = 99;
  for (const auto* look : {&of_field, &of_closer}) {
    for (const estimator::Hypothesis& h : *look) {
      outcome.of_field_cm = std::min(outcome.of_field_cm, error_cm(h.prior.nodes, truth));
    }
  }
  outcome.best_cm = outcome.of_field_cm;
  for (const auto& h : of_mask)
    outcome.best_cm = std::min(outcome.best_cm, error_cm(h.prior.nodes, truth));
  return outcome;
}

struct Sum {
  std::size_t count = 0;
  double sum = 0;
  std::size_t over = 0;
  void add(double cm) {
    ++count;
    sum += std::min(cm, 100.0);
    over += cm > 2 ? 1 : 0;
  }
  [[nodiscard]] std::string text() const {
    const auto n = static_cast<double>(count);
    return fmt::format("{:.3f} / {:.1f}", sum / n, 100 * static_cast<double>(over) / n);
  }
};

void report(const std::vector<Outcome>& outcomes, const Options& options) {
  std::map<std::string, std::vector<Sum>> rows;
  std::vector<double> field_ms;
  std::vector<double> path_ms;
  std::vector<double> mask_ms;
  for (const Outcome& o : outcomes) {
    for (const std::string& name :
         {std::string(" all"), std::string(o.clear ? " clear" : " doubtful"), o.scenario}) {
      auto& row = rows[name];
      row.resize(6);
      row[0].add(o.mask_cm);
      row[1].add(o.field_cm);
      row[2].add(o.closer_cm);
      row[3].add(o.scored_cm);
      row[4].add(o.of_field_cm);
      row[5].add(o.best_cm);
    }
    field_ms.push_back(o.field_ms);
    path_ms.push_back(o.path_ms);
    mask_ms.push_back(o.mask_ms);
    if (o.field_cm > options.list_over_cm) {
      fmt::print("{} {}: mask {:.2f}, field {:.2f}, best of field {:.2f}, best {:.2f}\n", o.index,
                 o.scenario, o.mask_cm, o.field_cm, o.of_field_cm, o.best_cm);
    }
  }
  fmt::print(
      "Index error, cm / share over 2 cm, %\n| | scenes | mask | field | closer | better score | "
      "nearest of the field | nearest of all |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, row] : rows) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, row[0].count, row[0].text(),
               row[1].text(), row[2].text(), row[3].text(), row[4].text(), row[5].text());
  }
  for (auto* ms : {&mask_ms, &field_ms, &path_ms}) {
    std::sort(ms->begin(), ms->end());
    fmt::print("ms: median {:.1f}, 99 % {:.1f}, most {:.1f}\n", (*ms)[ms->size() / 2],
               (*ms)[ms->size() * 99 / 100], ms->back());
  }
}

int run(const Options& options) {
  if (!options.pictures.empty()) std::filesystem::create_directories(options.pictures);
  const auto weights = flowdlo::strand::weights_of(options.range);
  if (!weights) return 1;
  auto outcomes = flowdlo::strand::over_scenes<Outcome>(
      options.range, weights, [&](std::uint64_t index, field::Network& network) {
        return measure(options, index, network);
      });
  if (outcomes.empty()) return 1;
  report(outcomes, options);
  return 0;
}

}  // namespace

namespace flowdlo::lab {

void add_reading_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "reading-report",
      "The centerline of the mask and of a strand field, before any model or gate");
  flowdlo::strand::add_options(app, options->range);
  app.add_option("--list-over", options->list_over_cm,
                 "Name scenes whose field's error is larger, cm");
  app.add_option("--pictures", options->pictures, "Folder for pictures of every scene");
  support::set_action(app, exit_code, [options] { return ::run(*options); });
}

}  // namespace flowdlo::lab
