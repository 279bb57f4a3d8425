// flowdlo-lab energy-fit: the weights of the path's energy (engine/path/energy.hpp), from scenes
// with truth. Each end of a strand might have gone on with another one, or stopped, and the ends
// that this frees would stop: what the rope really does is to be likelier than every such change.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "link_fit/labels.hpp"
#include "path/links.hpp"
#include "strand/scene_range.hpp"
#include "survey/choice_fit.hpp"
#include "survey/table.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::VectorXd;

// Those of a link and of a stop. Where there is one rope,
// it has two ends whatever they cost: their start is a term of its own, which means nothing.
constexpr std::size_t kStartOfOne = path::LinkTerms{}.size() + path::StopTerms{}.size();
constexpr std::size_t kTerms = kStartOfOne + 1;
constexpr std::size_t kMostStrands = 60;

/// The terms of what a change costs, beside what really happens.
using Option = std::array<double, kTerms>;

/// What may happen at the ends of a scene's strands; what does is the first option.
struct Outcome {
  std::uint64_t index = 0;
  std::vector<survey::Choice> choices;
};

/// Options at the ends of strands.
class Changes {
 public:
  explicit Changes(const Labelled& labelled)
      : strands_(labelled.strands),
        cover_(labelled.region, labelled.frame, strands_.width_px, strands_.seen),
        partners_(labelled.partners),
        one_rope_(!strands_.several),
        opinion_(labelled.opinion) {}

  std::vector<survey::Choice> all() const {
    std::vector<survey::Choice> choices;
    const auto ends = static_cast<int>(partners_.size());
    for (int end = 0; end < ends; ++end) {
      if (partner(end) == kUnknown) continue;
      std::vector<Option> options(1);
      if (partner(end) >= 0) options.push_back(freed(end));
      for (int other = 0; other < ends; ++other) {
        if (other == end || other == partner(end) || strands_.list[other / 2].ring) continue;
        if (other / 2 == end / 2 && one_rope_) continue;
        options.push_back(joined(end, other));
      }
      if (options.size() > 1) choices.push_back({rows_of(options)});
    }
    return choices;
  }

 private:
  static Eigen::MatrixXd rows_of(const std::vector<Option>& options) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(options.size()), kTerms);
    for (std::size_t i = 0; i < options.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) =
          -Eigen::Map<const Eigen::RowVectorXd>(options[i].data(), kTerms);  // costs are disliked
    }
    return rows;
  }
  [[nodiscard]] const path::LinkTerms& weights() const {
    return one_rope_ ? path::kOneRopeLinks : path::kSeveralRopesLinks;
  }
  [[nodiscard]] int partner(int end) const { return partners_[static_cast<std::size_t>(end)]; }

  void add_stop(int end, double sign, Option& option) const {
    const auto terms =
        path::stop_terms(strands_.end(end), opinion_.goes_on.empty() ? 0 : opinion_.goes_on[end]);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const bool start = i == path::kStopStart && one_rope_;
      option[start ? kStartOfOne : path::kLinkTerms + i] += sign * static_cast<double>(terms[i]);
    }
  }
  void add_link(int from, int to, double sign, Option& option) const {
    constexpr float kAny = std::numeric_limits<float>::max();
    const float elsewhere = opinion_.against(from, to);
    const auto terms =
        path::link_between(from, to, strands_, cover_, weights(), kAny, elsewhere).terms;
    for (std::size_t i = 0; i < terms.size(); ++i)
      option[i] += sign * static_cast<double>(terms[i]);
  }

  /// `end` has lost what it had, and `lost` stops where it had something.
  void lose(int end, Option& option) const {
    const int had = partner(end);
    if (had == kStops) add_stop(end, -1, option);
    if (had < 0) return;
    add_link(end, had, -1, option);
    add_stop(had, 1, option);
  }

  [[nodiscard]] Option freed(int end) const {
    Option option{};
    lose(end, option);
    add_stop(end, 1, option);
    return option;
  }

  [[nodiscard]] Option joined(int end, int other) const {
    Option option{};
    lose(end, option);
    add_link(end, other, 1, option);
    if (partner(other) != kUnknown) {
      lose(other, option);
      return option;
    }
    add_stop(other ^ 1, 1, option);
    return option;
  }

  const path::Strands& strands_;
  path::Cover cover_;
  const std::vector<int>& partners_;
  bool one_rope_;
  const path::Opinion& opinion_;
};

Result<Outcome> measure(synth::Split split, const std::string& part, std::uint64_t index,
                        field::Network& network) {
  synth::Render render;
  render.dense = true;
  auto scene = synth::make_frame(split, *synth::part_of(part), 0, index, render);
  if (!scene) return scene.error();
  const bool one_rope = scene->ropes.size() == 1;
  Outcome outcome{index, {}};
  const bool ring = std::any_of(scene->ropes.begin(), scene->ropes.end(),
                                [](const synth::TrueRope& rope) { return rope.closed; });
  if (ring) return outcome;  // it begins nowhere
  const auto labelled = label(*std::move(scene), !one_rope, network);
  if (!labelled) return labelled.error();
  if ((*labelled)->strands.list.size() > kMostStrands) return outcome;
  outcome.choices = Changes(**labelled).all();
  return outcome;
}

const std::array<const char*, kTerms> kNames{
    "link: long", "bend",      "bend of a stump", "open",   "unshown", "color",
    "depth",      "elsewhere", "stop: start",     "unseen", "goes on", "start of one"};

struct Options {
  strand::SceneRange range;
  std::uint64_t several = 0;
  double ridge = 2;
  std::string without;
};

/// As the engine has them; the start of one rope means nothing.
VectorXd compiled_weights() {
  VectorXd weights = VectorXd::Zero(kTerms);
  for (std::size_t i = 0; i < path::kLinkTerms; ++i) {
    weights[static_cast<Eigen::Index>(i)] = path::kSeveralRopesLinks[i];
  }
  for (std::size_t i = 0; i < path::kStopTerms; ++i) {
    weights[static_cast<Eigen::Index>(path::kLinkTerms + i)] = path::kStopWeights[i];
  }
  return weights;
}

void print(const Options& options, const std::vector<survey::Choice>& fitted,
           const std::vector<survey::Choice>& held) {
  std::vector<bool> fixed(kTerms);
  for (std::size_t i = 0; i < kTerms; ++i) {
    fixed[i] = ("," + options.without + ",").find(fmt::format(",{},", i)) != std::string::npos;
  }
  const VectorXd all = survey::fit(fitted, kTerms, options.ridge, fixed);
  const auto best = survey::quality_of(held, all);
  const auto before = survey::quality_of(held, compiled_weights());
  fmt::print(
      "{} choices fitted, {} held out\nnow: {:.4f}, right {:.2f} %\nfitted: {:.4f}, right {:.2f} "
      "%\n",
      fitted.size(), held.size(), before.unlikely, 100 * before.right, best.unlikely,
      100 * best.right);
  survey::Table table({"term", "weight", "without it", "right, %"});
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (fixed[i]) continue;
    auto others = fixed;
    others[i] = true;
    const auto quality =
        survey::quality_of(held, survey::fit(fitted, kTerms, options.ridge, others));
    table.add({kNames[i], fmt::format("{:.3f}", all[static_cast<Eigen::Index>(i)]),
               fmt::format("{:+.4f}", quality.unlikely - best.unlikely),
               fmt::format("{:.2f}", 100 * quality.right)});
  }
  fmt::print("{}", table.text());
}

int run(const Options& options) {
  auto range = options.range;
  std::vector<survey::Choice> fitted;
  std::vector<survey::Choice> held;
  for (const auto split : {synth::Split::kWide, synth::Split::kSeveral}) {
    if (split == synth::Split::kSeveral) range.scenes = options.several;
    const auto outcomes =
        strand::over_scenes<Outcome>(range, [&](std::uint64_t index, field::Network& network) {
          return measure(split, range.part, index, network);
        });
    for (const Outcome& outcome : outcomes) {
      auto& part = outcome.index % 4 == 0 ? held : fitted;
      part.insert(part.end(), outcome.choices.begin(), outcome.choices.end());
    }
  }
  if (fitted.empty()) return 1;
  print(options, fitted, held);
  return 0;
}

}  // namespace

void add_energy_fit(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "energy-fit", "The weights of the path's energy, fitted to scenes with truth");
  options->range.part = "training";
  strand::add_options(app, options->range);
  app.add_option("--several", options->several,
                 "So many scenes of several ropes as well, from the same on");
  app.add_option("--ridge", options->ridge, "Half the weight of the weights' squares");
  app.add_option("--without", options->without,
                 "Terms that are not used, by their numbers, as 5,8");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
