// flowdlo-lab field-report: what a strand field finds on scenes with truth, beside thinning of the
// mask.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "field/channel.hpp"
#include "field/sight.hpp"
#include "field/strand_field.hpp"
#include "mat/mat_file.hpp"
#include "mat/mat_image.hpp"
#include "strand/measure.hpp"
#include "strand/scene_range.hpp"
#include "strand/targets.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::lab {
namespace {

using strand::Counts;

struct Options {
  strand::SceneRange range;
  std::string drop = "nothing";
  std::string colors = "given";
  double width = 1;
  std::filesystem::path pictures;
  std::size_t worst = 12;
};

/// What one scene gave.
struct Outcome {
  std::uint64_t index = 0;
  std::string scenario;
  double width_px = 0;
  Counts field;
  Counts thinning;
  strand::TipLevels tips;
  double ms = 0;
  std::size_t blocks = 0;
};

/// 100 % of none.
double percent(long part, long whole) {
  return whole > 0 ? survey::percent(static_cast<double>(part), static_cast<double>(whole)) : 100;
}

void add_row(const std::string& name, std::size_t scenes, const Counts& c, survey::Table& table) {
  const auto both = [](double recall, double precision) {
    return fmt::format("{:.1f} / {:.1f}", recall, precision);
  };
  table.add(
      {name, std::to_string(scenes), both(percent(c.found, c.places), percent(c.right, c.shown)),
       both(percent(c.merged_found, c.merged_places), percent(c.merged_right, c.merged_shown)),
       both(percent(c.ends_found, c.ends), percent(c.tips_right, c.tips)),
       fmt::format("{:.1f} of {}", percent(c.crossings_right, c.crossings), c.crossings)});
}

constexpr double kDark = 0.06;  // of the light; 8 bits keep a few levels of it
constexpr double kNoise = 1.5;  // levels
constexpr int kBlur_px = 11;    // that everything moved by while the shutter was open
constexpr std::uint64_t kNoiseSeed = 5;
constexpr float kLeastTip = 0.3F;  // in the table of other thresholds

/// What a camera would have given of a picture.
cv::Mat as_seen(const cv::Mat& bgr, const std::string& colors) {
  cv::Mat seen = bgr.clone();
  const auto add_noise = [](double light, const cv::Mat& from, cv::Mat& to) {
    cv::Mat noise(from.size(), CV_16SC3);
    cv::RNG random(kNoiseSeed);
    random.fill(noise, cv::RNG::NORMAL, 0, kNoise);
    cv::addWeighted(from, light, noise, 1, 0, to, CV_8U);
  };
  if (colors == "flat") {  // without noise it would be taken for none
    const cv::Mat one(bgr.size(), bgr.type(), cv::mean(bgr));
    add_noise(1, one, seen);
  }
  if (colors == "grey") {
    cv::cvtColor(bgr, seen, cv::COLOR_BGR2GRAY);
    cv::cvtColor(seen, seen, cv::COLOR_GRAY2BGR);
  }
  if (colors == "dark") add_noise(kDark, bgr, seen);
  if (colors == "blurred") cv::blur(bgr, seen, {kBlur_px, 1});
  return seen;
}

/// A frame with other colours than the scene's, or without colour or depth.
struct Dropped {
  cv::Mat color;
  std::vector<float> depth_m;
  Frame frame;

  Dropped(const Frame& whole, const std::string& drop, const std::string& colors) : frame(whole) {
    if (colors != "given" && !frame.color_bgr.empty()) {
      // The pixels are only read; cv::Mat has no other way to say so.
      const cv::Mat given(frame.height, frame.width, CV_8UC3,
                          const_cast<std::uint8_t*>(frame.color_bgr.data()));
      color = as_seen(given, colors);
      frame.color_bgr = {color.ptr(), color.total() * color.elemSize()};
    }
    if (drop == "color" || drop == "both") frame.color_bgr = {};
    if (drop == "depth" || drop == "both") {
      depth_m.assign(whole.depth_m.size(), 0);
      frame.depth_m = depth_m;
    }
  }
};

/// Of this thread's time on a processor: other programs on the machine do not count.
double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double true_width_px(const synth::SyntheticFrame& scene) {
  double depth = 0;
  for (const auto& node : scene.truth()) depth += static_cast<double>(node.z) / kNodes;
  return 2 * scene.ropes.front().radius_m * static_cast<double>(scene.folder.intrinsics.fx) / depth;
}

/// The region in colour, the mask, the field's centre and direction, and tips and edges, side by
/// side. In colour and beside the mask: ends that show in green rings, tips in yellow ones where
/// they are right and in red ones where they are not.
cv::Mat picture(const Frame& frame, const field::StrandField& seen,
                const std::vector<strand::Strand>& strands, const strand::TipLevels& levels) {
  const field::Sight sight = field::look(frame, seen.region);
  const cv::Size size = mat::size_of(seen.channels.size());
  cv::Mat result(size.height, 4 * size.width, CV_8UC3, cv::Scalar::all(0));
  const auto byte = [](float value) { return cv::saturate_cast<std::uint8_t>(255 * value); };
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const auto& at = seen.channels.at(v, u);
      auto* const to = result.ptr<cv::Vec3b>(v) + u;
      if (!sight.color.empty()) {
        const auto& c = sight.color.at(v, u);
        to[0] = {byte(c[0]), byte(c[1]), byte(c[2])};
      }
      to[size.width] = cv::Vec3b::all(byte(sight.mask.at(v, u)));
      const float length = std::max(1e-3F, std::hypot(at[field::kCos], at[field::kSin]));
      const float centre = at[field::kCentre];
      to[2 * size.width] = {byte(centre * (0.5F + 0.5F * at[field::kCos] / length)),
                            byte(centre * (0.5F + 0.5F * at[field::kSin] / length)), byte(centre)};
      to[3 * size.width] = {byte(std::max(at[field::kUnder], at[field::kEdge])),
                            byte(0.5F * at[field::kRope]), byte(at[field::kTip])};
    }
  }
  const auto ring = [&](float u, float v, int radius, const cv::Scalar& color) {
    for (const int panel : {0, 1, 3}) {
      cv::circle(
          result,
          {panel * size.width + static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))},
          radius, color);
    }
  };
  for (const auto& end : strand::visible_tips(strands)) ring(end.x, end.y, 9, {0, 255, 0});
  for (const auto& tip : levels.tips) {
    if (tip.level < field::kTipPeak) continue;
    ring(tip.px.x(), tip.px.y(), 6, tip.right ? cv::Scalar(0, 255, 255) : cv::Scalar(0, 0, 255));
  }
  return result;
}

Result<Outcome> measure(const Options& options, std::uint64_t index, field::Network& network,
                        cv::Mat* drawn) {
  const auto scene = options.range.make(index, {.dense = true});
  if (!scene) return scene.error();
  const Dropped dropped(scene->frame(), options.drop, options.colors);
  Outcome outcome;
  outcome.index = index;
  outcome.scenario = scene->meta.scenario;
  outcome.width_px = true_width_px(*scene);
  const double width_px = options.width * outcome.width_px;
  const double begin_ms = thread_ms();
  const auto seen = field::see(dropped.frame, static_cast<float>(width_px), network);
  if (!seen) return seen.error();
  outcome.ms = thread_ms() - begin_ms;
  const auto strands = strand::in_region(strand::strands_of(*scene), seen->region);
  const auto looked = field::look(dropped.frame, seen->region);
  const cv::Mat mask = mat::mat_over(looked.mask);
  outcome.blocks = field::blocks_near(looked.mask).blocks.size();
  outcome.field =
      strand::measure(strands, mask, field::ridges(seen->channels), field::tips(seen->channels));
  const auto channels = seen->channels.whole();
  strand::measure_crossings(strands, mat::mat_over(channels), outcome.field);
  outcome.thinning = strand::measure(strands, mask, strand::thinned(mask), {});
  outcome.tips = strand::tip_levels(strands, seen->channels, kLeastTip);
  if (drawn != nullptr) *drawn = picture(dropped.frame, *seen, strands, outcome.tips);
  return outcome;
}

/// What other values of field::kTipPeak would find.
std::string table_of(const strand::TipLevels& levels) {
  survey::Table table({"least tip", "ends: recall / precision, %"});
  for (float least = kLeastTip; least < 0.96F; least += 0.05F) {
    const auto ends = std::count_if(levels.ends.begin(), levels.ends.end(),
                                    [&](float level) { return level >= least; });
    long shown = 0;
    long right = 0;
    for (const auto& tip : levels.tips) {
      if (tip.level < least) continue;
      ++shown;
      right += tip.right;
    }
    table.add({fmt::format("{:.2f}", least),
               fmt::format("{:.1f} / {:.1f}", percent(ends, static_cast<long>(levels.ends.size())),
                           percent(right, shown))});
  }
  return table.text();
}

std::string width_group(double width_px) {
  const std::vector<std::pair<double, const char*>> bounds{
      {2.5, "2 to 2.5 px"}, {3.5, "2.5 to 3.5 px"}, {5, "3.5 to 5 px"}, {10, "5 to 10 px"}};
  for (const auto& [most, name] : bounds) {
    if (width_px < most) return name;
  }
  return "10 px and more";
}

void report(const std::vector<Outcome>& outcomes) {
  struct Group {
    std::size_t scenes = 0;
    Counts counts;
  };
  Counts all;
  Counts thinning;
  std::map<std::string, Group> scenarios;
  std::map<std::string, Group> widths;
  strand::TipLevels tips;
  survey::Values ms;
  survey::Values blocks;
  for (const Outcome& outcome : outcomes) {
    all += outcome.field;
    thinning += outcome.thinning;
    tips += outcome.tips;
    for (Group* group : {&scenarios[outcome.scenario], &widths[width_group(outcome.width_px)]}) {
      ++group->scenes;
      group->counts += outcome.field;
    }
    ms.add(outcome.ms);
    blocks.add(static_cast<double>(outcome.blocks));
  }
  survey::Table table({"", "scenes", "all: recall / precision, %", "merged: recall / precision, %",
                       "ends: recall / precision, %", "upper strand at crossings, %"});
  add_row("thinning of the mask", outcomes.size(), thinning, table);
  add_row("**field**", outcomes.size(), all, table);
  for (const auto* groups : {&scenarios, &widths}) {
    for (const auto& [name, group] : *groups) add_row(name, group.scenes, group.counts, table);
  }
  fmt::print(
      "{}{}ms of a processor a field, one thread: median {:.1f}, 99 % {:.1f}; blocks: median "
      "{:.0f}, 99 % {:.0f}\n",
      table.text(), table_of(tips), ms.median(), ms.quantile(0.99), blocks.median(),
      blocks.quantile(0.99));
}

/// Pictures of the scenes in which most places are missed.
Result<void> draw_worst(const Options& options, std::vector<Outcome> outcomes) {
  std::stable_sort(outcomes.begin(), outcomes.end(), [](const Outcome& a, const Outcome& b) {
    return a.field.places - a.field.found > b.field.places - b.field.found;
  });
  std::filesystem::create_directories(options.pictures);
  auto network = strand::one_network(options.range.weights);
  if (!network) return network.error();
  for (std::size_t i = 0; i < std::min(options.worst, outcomes.size()); ++i) {
    cv::Mat drawn;
    if (!measure(options, outcomes[i].index, *network, &drawn)) continue;
    const auto file = options.pictures /
                      fmt::format("{:02}_{}_{}.png", i, outcomes[i].index, outcomes[i].scenario);
    if (auto saved = mat::save_png(file, drawn); !saved) return saved;
    const Counts& c = outcomes[i].field;
    fmt::print("{}: {} of {} places missed; {} of {} tips are none, {} of {} ends missed\n",
               file.string(), c.places - c.found, c.places, c.tips - c.tips_right, c.tips,
               c.ends - c.ends_found, c.ends);
  }
  return {};
}

int run(const Options& options) {
  const auto outcomes = strand::over_scenes<Outcome>(
      options.range, [&](std::uint64_t index, field::Network& network) {
        return measure(options, index, network, nullptr);
      });
  if (outcomes.empty()) return 1;
  report(outcomes);
  if (options.pictures.empty()) return 0;
  const auto drawn = draw_worst(options, outcomes);
  return drawn ? 0 : survey::failed(drawn.error());
}

}  // namespace

void add_field_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "field-report",
      "What a strand field finds on scenes with truth, beside thinning of the mask");
  options->range.scenes = 100;
  strand::add_options(app, options->range);
  app.add_option("--drop", options->drop, "What the camera does not give")
      ->check(CLI::IsMember({"nothing", "color", "depth", "both"}));
  app.add_option("--colors", options->colors, "What becomes of the scene's colours")
      ->check(CLI::IsMember({"given", "flat", "grey", "dark", "blurred"}));
  app.add_option("--width", options->width, "The width believed, over the true one")
      ->check(CLI::Range(0.1, 10.0));
  app.add_option("--pictures", options->pictures, "Folder for pictures of the worst scenes");
  app.add_option("--worst", options->worst, "How many pictures")->check(CLI::Range(0, 1000));
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
