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
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::lab {
namespace {

struct Options {
  strand::SceneRange range;
  double list_over_cm = 1e9;
  std::filesystem::path pictures;
};

/// Errors in centimetres, and what took how long.
struct Outcome {
  std::uint64_t index = 0;
  std::string scenario;
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

double error_cm(const Centerline& nodes, const Centerline& truth) {
  return 100 * eval::score(nodes, truth).either_index_m;
}

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// What the field shows, nearness to axes red, tips green, strands below blue; the lines that are
/// followed in it, in colours that change; the truth, dotted in white; and the best path, thin,
/// from blue to yellow.
void draw(const std::filesystem::path& file, const field::StrandField& seen, const path::Path& path,
          const Centerline& truth, const Intrinsics& camera) {
  constexpr float kTimes = 2;
  cv::Mat picture(mat::size_of(seen.channels.size()), CV_8UC3);
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
  for (const Point3& node : truth) {
    nodes.push_back(geometry::project(camera, node));
  }
  for (const Eigen::Vector2f& p : geometry::resample(nodes, 400)) {
    cv::circle(picture, place(seen.region.to_region(p)), 1, cv::Scalar::all(255), cv::FILLED);
  }
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(path.points_px.size());
    cv::line(picture, place(seen.region.to_region(path.points_px[i - 1])),
             place(seen.region.to_region(path.points_px[i])),
             cv::Scalar(255 * (1 - t), 255 * t, 255 * t), 1);
  }
  if (const auto saved = mat::save_png(file, picture); !saved) {
    fmt::print(stderr, "{}\n", saved.error().message);
  }
}

/// Best first; none where there are no paths or nothing can be made of them.
std::vector<estimator::Hypothesis> lifted(const Result<path::Traversals>& paths,
                                          const estimator::Conditions& conditions,
                                          const Frame& frame) {
  if (!paths) return {};
  auto hypotheses = estimator::lift_all(*paths, conditions.cloud, conditions.visible, frame,
                                        weights::PriorKind::kRefined);
  return hypotheses ? *std::move(hypotheses) : std::vector<estimator::Hypothesis>();
}

Result<Outcome> measure(const Options& options, std::uint64_t index, field::Network& network) {
  const auto scene = options.range.make(index);
  if (!scene) return scene.error();
  const Frame frame = scene->frame();
  const auto truth = scene->truth();
  Outcome outcome;
  outcome.index = index;
  outcome.scenario = scene->meta.scenario;
  Timings timings;
  auto begin = std::chrono::steady_clock::now();
  const auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) return conditions.error();
  outcome.mask_ms = ms_since(begin);
  const auto& of_mask = conditions->hypotheses;
  begin = std::chrono::steady_clock::now();
  const auto glance = path::glance(frame);
  if (!glance) return glance.error();
  const auto seen = field::see(frame, glance->rope_width_px, network);
  if (!seen) return seen.error();
  outcome.field_ms = ms_since(begin);
  begin = std::chrono::steady_clock::now();
  const auto axes = field::axes(*seen);
  const auto paths = path::trace_strands(frame, axes);
  const auto of_field = lifted(paths, *conditions, frame);
  outcome.path_ms = ms_since(begin);
  const auto nearer = field::see(frame, estimator::kCloser * axes.width_px, network);
  const auto of_closer =
      nearer ? lifted(path::trace_strands(frame, field::axes(*nearer)), *conditions, frame)
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

std::string text(const survey::Values& cm) {
  return fmt::format("{:.3f} / {:.1f}", cm.mean(), cm.percent_over(2));
}

void report(const std::vector<Outcome>& outcomes, const Options& options) {
  constexpr double kMost_cm = 100;  // a scene counts no more
  std::map<std::string, std::array<survey::Values, 6>> rows;
  std::array<survey::Values, 3> times;
  for (const Outcome& o : outcomes) {
    const std::array<double, 6> errors_cm{o.mask_cm,   o.field_cm,    o.closer_cm,
                                          o.scored_cm, o.of_field_cm, o.best_cm};
    for (const std::string& name : {std::string(" all"), o.scenario}) {
      auto& row = rows[name];
      for (std::size_t i = 0; i < row.size(); ++i) row[i].add(std::min(errors_cm[i], kMost_cm));
    }
    times[0].add(o.mask_ms);
    times[1].add(o.field_ms);
    times[2].add(o.path_ms);
    if (o.field_cm > options.list_over_cm) {
      fmt::print("{} {}: mask {:.2f}, field {:.2f}, best of field {:.2f}, best {:.2f}\n", o.index,
                 o.scenario, o.mask_cm, o.field_cm, o.of_field_cm, o.best_cm);
    }
  }
  survey::Table table({"", "scenes", "mask", "field", "closer", "better score",
                       "nearest of the field", "nearest of all"});
  for (const auto& [name, row] : rows) {
    std::vector<std::string> cells{name, std::to_string(row[0].count())};
    for (const survey::Values& cm : row) cells.push_back(text(cm));
    table.add(std::move(cells));
  }
  fmt::print("Index error, cm / share over 2 cm, %\n{}", table.text());
  for (const survey::Values& ms : times) {
    fmt::print("ms: median {:.1f}, 99 % {:.1f}, most {:.1f}\n", ms.median(), ms.quantile(0.99),
               ms.most());
  }
}

int run(const Options& options) {
  if (!options.pictures.empty()) std::filesystem::create_directories(options.pictures);
  const auto outcomes = strand::over_scenes<Outcome>(
      options.range, [&](std::uint64_t index, field::Network& network) {
        return measure(options, index, network);
      });
  if (outcomes.empty()) return 1;
  report(outcomes, options);
  return 0;
}

}  // namespace

void add_reading_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "reading-report",
      "The centerline of the mask and of a strand field, before any model or gate");
  strand::add_options(app, options->range);
  app.add_option("--list-over", options->list_over_cm,
                 "Name scenes whose field's error is larger, cm");
  app.add_option("--pictures", options->pictures, "Folder for pictures of every scene");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
