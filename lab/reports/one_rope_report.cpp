// flowdlo-lab one-rope-report: what `confidence` says of masks that are no rope, two ropes or part
// of one, and of ordinary frames, in one table. Training scenes unless told otherwise.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "eval/metrics.hpp"
#include "hostile/hostile_mask.hpp"
#include "one_rope/part_of_rope.hpp"
#include "one_rope/two_ropes.hpp"
#include "scene/random.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"
#include "survey/wide_scenes.hpp"
#include "synth/drawn_frame.hpp"

namespace flowdlo::lab {
namespace {

constexpr float kLow = 0.3F;       // below this a confidence says "do not use it"
constexpr double kRight_m = 0.01;  // mean error of what the confidence calls right
constexpr int kDoubts = 4;
constexpr std::array<std::pair<double, double>, 4> kParts{
    {{0, 0.5}, {0.35, 1}, {0.25, 0.75}, {0, 0.85}}};

struct Options {
  std::string weights;
  std::string csv;
  std::string part = "training";
  std::uint64_t first = 8000000;
  int drawn = 20;
  int wide = 400;
  int thesis = 100;
  int pairs = 60;
  int parts = 100;
  bool color = false;
  std::vector<int> sizes{320, 640};
};

struct Row {
  int frames = 0;
  int no_path = 0;
  int low = 0;
  int doubted = 0;
  int right = 0;
  int right_doubted = 0;
  std::array<int, kDoubts> doubts{};
};

class Report {
 public:
  Report(Estimator estimator, std::FILE* csv) : estimator_(std::move(estimator)), csv_(csv) {
    if (csv_ != nullptr) {
      fmt::print(csv_,
                 "group,name,confidence,error_m,doubts,explained,slender,sides,even,left_over,"
                 "off_mask,bare_gap,goes_on,ms\n");
    }
  }

  void add(const std::string& group, const FrameFolder& frame) {
    Row& row = rows_[group];
    ++row.frames;
    const auto estimate = estimator_.estimate(frame.frame());
    if (!estimate) {
      ++row.no_path;
      return;
    }
    const auto& one = estimate->one_rope;
    double error_m = -1;
    if (frame.truth) error_m = eval::score(estimate->nodes, *frame.truth).either_index_m;
    row.low += estimate->confidence < kLow ? 1 : 0;
    row.doubted += one.doubts.empty() ? 0 : 1;
    const bool right = frame.truth && error_m < kRight_m;
    row.right += right ? 1 : 0;
    row.right_doubted += right && !one.doubts.empty() ? 1 : 0;
    for (const Doubt doubt : one.doubts) ++row.doubts[static_cast<std::size_t>(doubt)];
    if (csv_ == nullptr) return;
    fmt::print(
        csv_,
        "{},{},{:.4f},{:.4f},{},{:.4f},{:.2f},{:.3f},{:.3f},{:.2f},{:.4f},{:.2f},{:.2f},{:.1f}\n",
        group, frame.name, estimate->confidence, error_m, one.doubts.size(), one.explained,
        one.slender, one.sides, one.even, one.left_over, one.off_mask, one.bare_gap, one.goes_on,
        estimate->timings.gate_ms);
    std::fflush(csv_);
  }

  void print() const {
    survey::Table table({"frames", "number", "no path", "confidence < 0.3", "right (< 1 cm)",
                         "right and doubted", "no rope", "strands left", "bare gap", "goes on"});
    for (const auto& [group, row] : rows_) {
      std::vector<std::string> cells{
          group,
          std::to_string(row.frames),
          std::to_string(row.no_path),
          fmt::format("{} ({:.1f} %)", row.low, survey::percent(row.low + row.no_path, row.frames)),
          std::to_string(row.right),
          fmt::format("{} ({:.2f} %)", row.right_doubted,
                      survey::percent(row.right_doubted, row.right))};
      for (const int doubts : row.doubts) cells.push_back(std::to_string(doubts));
      table.add(std::move(cells));
    }
    fmt::print("{}", table.text());
  }

 private:
  Estimator estimator_;
  std::FILE* csv_;
  std::map<std::string, Row> rows_;
};

/// An empty name: none was made.
FrameFolder rendered_frame(const Options& options, synth::Split split, std::uint64_t number) {
  const synth::Part part = *synth::part_of(options.part);
  auto made = synth::frame_at(split, part, options.first + number, {.color = options.color});
  if (!made) return {};
  made->folder.name = fmt::format("{}_{}", made->meta.scenario, number);
  return std::move(made->folder);
}

using Maker = std::function<FrameFolder(std::uint64_t)>;

void add_ropeless(const Options& options, Report& report) {
  for (const int width : options.sizes) {
    const int height = width * 3 / 4;
    const auto focal = static_cast<float>(width);
    FrameFolder frame;
    frame.width = width;
    frame.height = height;
    frame.intrinsics = {focal, focal, focal / 2, static_cast<float>(height) / 2};
    Random random(static_cast<std::uint64_t>(width));
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        frame.depth_m.push_back(
            static_cast<float>(0.6 + 0.1 * v / height + 0.001 * random.gaussian()));
      }
    }
    for (const HostileMask& odd : ropeless_masks({width, height})) {
      frame.name = odd.name();
      const cv::Mat1b mask = draw(odd);
      frame.mask.assign(mask.begin(), mask.end());
      report.add("a no rope " + std::to_string(width), frame);
    }
  }
}

void add_pairs(const std::string& made_by, int pairs, const Maker& make, Report& report) {
  std::map<std::pair<int, int>, FrameFolder> waiting;
  std::map<Arrangement, int> made;
  for (std::uint64_t i = 0; made[Arrangement::kJoined] < pairs; ++i) {
    FrameFolder frame = make(i);
    if (frame.name.empty()) continue;
    FrameFolder& other = waiting[{frame.width, frame.height}];
    if (!other.name.empty()) {
      for (int k = 0; k < kArrangements; ++k) {
        const auto arrangement = static_cast<Arrangement>(k);
        auto pair = two_ropes(other, frame, arrangement, i);
        if (pair) {
          pair->name = other.name + "+" + frame.name;
          report.add(fmt::format("b {} {}", name_of(arrangement), made_by), *pair);
        }
        if (pair || arrangement == Arrangement::kJoined) ++made[arrangement];
      }
    }
    other = std::move(frame);
  }
}

void add_parts(const std::string& made_by, int count, const Maker& make, Report& report) {
  for (int i = 0; i < count; ++i) {
    const FrameFolder whole = make(static_cast<std::uint64_t>(i));
    if (whole.name.empty()) continue;
    for (const auto& [from, to] : kParts) {
      report.add(fmt::format("c {:.2f} to {:.2f} {}", from, to, made_by),
                 part_of_rope(whole, from, to));
    }
  }
}

void add_all(const Options& options, Report& report) {
  const Maker drawn = [&](std::uint64_t i) {
    const auto kind = static_cast<Kind>(i % kKinds);
    const std::uint64_t seed = options.first + i / kKinds;
    FrameFolder frame = std::move(synth::drawn_frame(kind, seed).folder);
    frame.name = fmt::format("{}_{}", name_of(kind), seed);
    return frame;
  };
  const Maker wide = [&](std::uint64_t i) {
    return rendered_frame(options, synth::Split::kWide, i);
  };
  const Maker thesis = [&](std::uint64_t i) {
    return rendered_frame(options, synth::Split::kThesis, i);
  };
  const auto add = [&](const char* group, int count, const Maker& make) {
    for (int i = 0; i < count; ++i) {
      const FrameFolder frame = make(static_cast<std::uint64_t>(i));
      if (!frame.name.empty()) report.add(group, frame);
    }
  };
  add("d ordinary drawn", options.drawn * kKinds, drawn);
  add("d ordinary wide", options.wide, wide);
  add("d ordinary thesis", options.thesis, thesis);
  add_pairs("drawn", options.pairs, drawn, report);
  add_pairs("wide", options.pairs, wide, report);
  add_parts("drawn", options.parts, drawn, report);
  add_parts("wide", options.parts, wide, report);
  if (options.pairs > 0) add_ropeless(options, report);
}

int run(const Options& options) {
  auto estimator = survey::one_estimator(options.weights);
  if (!estimator) return survey::failed(estimator.error());
  std::FILE* const csv = options.csv.empty() ? nullptr : std::fopen(options.csv.c_str(), "w");
  Report report(*std::move(estimator), csv);
  add_all(options, report);
  report.print();
  if (csv != nullptr) std::fclose(csv);
  return 0;
}

}  // namespace

void add_one_rope_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(program, "one-rope-report",
                                    "Confidence on masks that are not one rope");
  app.add_option("--weights", options->weights, "Weights of the model, .fdw")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--drawn", options->drawn, "Ordinary drawn scenes of each kind")
      ->capture_default_str();
  app.add_option("--wide", options->wide, "Ordinary frames of the wide split")
      ->capture_default_str();
  app.add_option("--thesis", options->thesis, "Ordinary frames of the thesis split")
      ->capture_default_str();
  app.add_option("--pairs", options->pairs, "Two ropes: of each arrangement, drawn and rendered")
      ->capture_default_str();
  app.add_option("--parts", options->parts, "Frames to cut, drawn and rendered")
      ->capture_default_str();
  app.add_option("--first", options->first, "Seed or index of the first")->capture_default_str();
  app.add_option("--part", options->part, "training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  app.add_flag("--color", options->color, "With colour in rendered frames; slow");
  app.add_option("--sizes", options->sizes, "Widths of masks that are no rope")
      ->capture_default_str();
  app.add_option("--csv", options->csv, "Everything measured, a line a frame")->type_name("FILE");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
