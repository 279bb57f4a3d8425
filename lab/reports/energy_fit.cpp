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
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "link_fit/choices.hpp"
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

/// The terms of what a stop or a link costs.
using Option = std::array<double, kTerms>;

/// What may happen at the ends of a scene's strands; what does is the first option.
struct Outcome {
  std::uint64_t index = 0;
  std::vector<survey::Choice> choices;
};

/// What the end's stop consists of.
Option stop_option(int end, const Labelled& labelled) {
  const bool one_rope = !labelled.strands.several;
  const auto terms = path::stop_terms(labelled.strands.end(end), labelled.opinion.going_on(end));
  Option option{};
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const bool start = i == path::kStopStart && one_rope;
    option[start ? kStartOfOne : path::kLinkTerms + i] = static_cast<double>(terms[i]);
  }
  return option;
}

/// And the link between two ends.
Option link_option(int a, int b, const Labelled& labelled, const path::Cover& cover) {
  const auto& weights = labelled.strands.several ? path::kSeveralRopesLinks : path::kOneRopeLinks;
  const auto terms =
      path::link_between(a, b, labelled.strands, cover, weights, std::numeric_limits<float>::max(),
                         labelled.opinion.against(a, b))
          .terms;
  Option option{};
  std::copy(terms.begin(), terms.end(), option.begin());
  return option;
}

/// Choices at the ends of strands, any two of which might be linked.
std::vector<survey::Choice> choices_at(const Labelled& labelled) {
  const path::Strands& strands = labelled.strands;
  const path::Cover cover(labelled.region, labelled.frame, strands.width_px, strands.seen);
  LinkSample sample;
  std::vector<Option> things;
  const auto count = static_cast<int>(labelled.partners.size());
  for (int end = 0; end < count; ++end) {
    sample.ends.push_back({.partner = labelled.partners[static_cast<std::size_t>(end)]});
    things.push_back(stop_option(end, labelled));
  }
  const auto known = [&](int end) {
    return labelled.partners[static_cast<std::size_t>(end)] != kUnknown;
  };
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      if (!known(a) && !known(b)) continue;
      if (strands.list[a / 2].ring || strands.list[b / 2].ring) continue;
      if (a / 2 == b / 2 && !strands.several) continue;
      sample.links.push_back({.a = a, .b = b});
      things.push_back(link_option(a, b, labelled, cover));
    }
  }
  std::vector<survey::Choice> choices;
  for (const EndChoice& choice : choices_of(sample)) {
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(choice.options.size()), kTerms);
    for (std::size_t i = 0; i < choice.options.size(); ++i) {
      for (const Change& change : choice.options[i]) {  // costs are disliked
        rows.row(static_cast<Eigen::Index>(i)) -=
            change.sign * Eigen::Map<const Eigen::RowVectorXd>(things[change.thing].data(), kTerms);
      }
    }
    choices.push_back({std::move(rows)});
  }
  return choices;
}

Result<Outcome> measure(synth::Split split, const std::string& part, std::uint64_t index,
                        field::Network& network) {
  synth::Render render;
  render.dense = true;
  auto scene = synth::make_frame(split, *synth::part_of(part), 0, index, render);
  if (!scene) return scene.error();
  const bool one_rope = scene->ropes.size() == 1;
  Outcome outcome{index, {}};
  if (has_ring(*scene)) return outcome;  // it begins nowhere
  const auto labelled = label(*std::move(scene), !one_rope, network);
  if (!labelled) return labelled.error();
  if ((*labelled)->strands.list.size() > kMostStrands) return outcome;
  outcome.choices = choices_at(**labelled);
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
      auto& part = outcome.index % strand::kHeldOut == 0 ? held : fitted;
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
