// flowdlo-lab link-fit: fits the network that says what links and stops cost
// (engine/path/link_network.hpp) to a strand field, on training scenes, and writes the field's
// weights with it. Every fourth scene is held out, and the table is of these.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "geometry/depth.hpp"
#include "geometry/quantile.hpp"
#include "link_fit/fit.hpp"
#include "link_fit/labels.hpp"
#include "link_fit/sample.hpp"
#include "strand/patch.hpp"
#include "strand/scene_range.hpp"
#include "survey/failed.hpp"
#include "survey/table.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::uint64_t kFlat = 5;       // has one depth everywhere, as photographs have it,
constexpr std::uint64_t kAsSeveral = 3;  // and of one rope is read as if there may be several

struct Options {
  strand::SceneRange range;
  std::uint64_t several = 0;
  std::uint64_t tangled = 0;
  std::uint64_t drawn = 0;
  int rounds = 60;
  std::string out;
};

/// One depth everywhere, that of the ropes.
void flatten(synth::SyntheticFrame& scene) {
  std::vector<float> depths_m;
  for (std::size_t p = 0; p < scene.folder.mask.size(); ++p) {
    const float z = scene.folder.depth_m[p];
    if (scene.folder.mask[p] > 127 && geometry::measured(z)) depths_m.push_back(z);
  }
  if (depths_m.empty()) return;
  std::fill(scene.folder.depth_m.begin(), scene.folder.depth_m.end(),
            geometry::median_of(depths_m));
}

Result<synth::SyntheticFrame> scene_of(synth::Split split, std::uint64_t index) {
  if (split == synth::Split::kDrawn) return strand::drawn_training_frame(0, index);
  synth::Render render = strand::render_of(index);
  render.dense = true;
  return synth::make_frame(split, synth::Part::kTraining, 0, index, render);
}

/// None of a scene that teaches nothing: a ring that is read as one rope has no ends.
Result<std::optional<LinkSample>> measure(synth::Split split, std::uint64_t index,
                                          field::Network& network) {
  auto scene = scene_of(split, index);
  if (!scene) return scene.error();
  if (index % kFlat == 0) flatten(*scene);
  const bool one = scene->ropes.size() == 1;
  const bool several = !one || index % kAsSeveral == 1;
  if (has_ring(*scene) && !several) return std::optional<LinkSample>();
  const auto labelled = label(*std::move(scene), several, network);
  if (!labelled) return labelled.error();
  if ((*labelled)->strands.list.size() > kMostStrands) return std::optional<LinkSample>();
  LinkSample sample = sample_of(**labelled);
  sample.index = index;
  const char* const made = split == synth::Split::kDrawn     ? "drawn"
                           : split == synth::Split::kTangled ? "tangled"
                                                             : "rendered";
  sample.kind = fmt::format("{} of {}, read as {}", made, one ? "one rope" : "several ropes",
                            several ? "several" : "one");
  return std::optional(std::move(sample));
}

struct Gathered {
  std::vector<LinkSample> fitted;
  std::map<std::string, std::vector<LinkSample>> held;  ///< by kind
};

Gathered gather(const Options& options) {
  Gathered gathered;
  auto range = options.range;
  for (const auto& [split, scenes] : {std::pair(synth::Split::kWide, options.range.scenes),
                                      std::pair(synth::Split::kSeveral, options.several),
                                      std::pair(synth::Split::kTangled, options.tangled),
                                      std::pair(synth::Split::kDrawn, options.drawn)}) {
    range.scenes = scenes;
    const auto of = split;
    for (auto& sample : strand::over_scenes<std::optional<LinkSample>>(
             range, [of](std::uint64_t index, field::Network&network) {
               return measure(of, index, network);
             })) {
      if (!sample) continue;
      auto& to =
          sample->index % strand::kHeldOut == 0 ? gathered.held[sample->kind] : gathered.fitted;
      to.push_back(*std::move(sample));
    }
  }
  return gathered;
}

void print(const Gathered& gathered, const weights::LinkWeights& weights) {
  survey::Table table({"held out", "choices", "loss by energy.hpp", "by the network",
                       "wrong by energy.hpp, %", "by the network, %"});
  for (const auto& [kind, samples] : gathered.held) {
    const LinkQuality before = quality_of(samples, nullptr);
    const LinkQuality now = quality_of(samples, &weights);
    table.add({kind, std::to_string(now.choices), fmt::format("{:.4f}", before.unlikely),
               fmt::format("{:.4f}", now.unlikely), fmt::format("{:.2f}", 100 * before.wrong),
               fmt::format("{:.2f}", 100 * now.wrong)});
  }
  fmt::print("{}", table.text());
}

int run(const Options& options) {
  auto field = weights::load_field(options.range.weights);
  if (!field) return survey::failed(field.error());
  const Gathered gathered = gather(options);
  if (gathered.fitted.empty()) {
    return survey::failed({ErrorCode::kNoEvidence,
                           "link-fit: expected scenes whose strands the field shows, got none; "
                           "raise --scenes"});
  }
  auto links = fit_links(gathered.fitted, options.rounds);
  print(gathered, links);
  links.notes = fmt::format(
      "flowdlo-lab link-fit, training scenes from {}: {} rendered of one rope, {} of several, {} "
      "tangled, {} drawn, three in four of each; {} rounds",
      options.range.first, options.range.scenes, options.several, options.tangled, options.drawn,
      options.rounds);
  field->links = std::move(links);
  const auto saved = weights::save_field(*field, options.out);
  return saved ? 0 : survey::failed(saved.error());
}

}  // namespace

void add_link_fit(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "link-fit", "The network that links a strand field's strands, fitted to scenes");
  options->range.part = "training";
  strand::add_options(app, options->range);
  app.add_option("--several", options->several,
                 "So many scenes of several ropes as well, from the same on");
  app.add_option("--tangled", options->tangled, "And so many of several that are looped or coiled");
  app.add_option("--drawn", options->drawn, "And so many drawn ones, half of them of one rope");
  app.add_option("--rounds", options->rounds, "Of the fit over all scenes")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--out", options->out, "The field's weights with the network, .safetensors")
      ->required();
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
