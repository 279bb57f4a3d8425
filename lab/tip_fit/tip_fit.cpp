// flowdlo-lab tip-fit: fits the network that says where a rope's tips lie (engine/refine/tips.hpp)
// to a strand field, on training scenes, and writes the field's weights with it. Every fourth scene
// is held out, and the table is of these.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "gate_fit/bare.hpp"
#include "strand/scene_range.hpp"
#include "survey/failed.hpp"
#include "survey/table.hpp"
#include "tip_fit/fit.hpp"
#include "tip_fit/sample.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::lab {
namespace {

struct Options {
  strand::SceneRange range;
  std::uint64_t several = 0;
  std::uint64_t tangled = 0;
  std::uint64_t thesis = 0;
  std::uint64_t drawn = 0;
  int rounds = 25;
  std::string out;
};

using Samples = std::vector<TipSample>;

Result<Samples> measure(synth::Split split, std::uint64_t index, field::Network& network) {
  const bool clean = split == synth::Split::kThesis;
  auto scene = synth::frame_at(split, synth::Part::kTraining, index,
                               clean ? synth::Render{} : strand::render_of(index));
  if (!scene) return scene.error();
  if (!clean) lay_bare(scene->folder, index);
  Samples samples =
      synth::has_several(split) ? samples_of_ropes(*scene, network) : samples_of(*scene, network);
  for (TipSample& sample : samples) {
    sample.index = index;
    sample.kind = synth::name_of(split);
  }
  return samples;
}

struct Gathered {
  Samples fitted;
  std::map<std::string, Samples> held;  ///< by kind
};

Gathered gather(const Options& options) {
  Gathered gathered;
  auto range = options.range;
  for (const auto& [split, scenes] : {std::pair(synth::Split::kWide, options.range.scenes),
                                      std::pair(synth::Split::kSeveral, options.several),
                                      std::pair(synth::Split::kTangled, options.tangled),
                                      std::pair(synth::Split::kThesis, options.thesis),
                                      std::pair(synth::Split::kDrawn, options.drawn)}) {
    range.scenes = scenes;
    range.first = split == synth::Split::kThesis ? 0 : options.range.first;
    const auto of = split;
    for (auto& samples :
         strand::over_scenes<Samples>(range, [of](std::uint64_t index, field::Network&network) {
           return measure(of, index, network);
         })) {
      for (TipSample& sample : samples) {
        const bool held = sample.index % strand::kHeldOut == 0;
        (held ? gathered.held[sample.kind] : gathered.fitted).push_back(std::move(sample));
      }
    }
  }
  return gathered;
}

void print(const Gathered& gathered, const weights::TipWeights& weights) {
  survey::Table table({"held out", "ends", "mean as they were", "by the network",
                       "median as they were", "by the network"});
  for (const auto& [kind, samples] : gathered.held) {
    const TipQuality before = quality_of(samples, nullptr);
    const TipQuality now = quality_of(samples, &weights);
    table.add({kind, std::to_string(now.ends), fmt::format("{:.3f}", before.mean),
               fmt::format("{:.3f}", now.mean), fmt::format("{:.3f}", before.median),
               fmt::format("{:.3f}", now.median)});
  }
  fmt::print("From tips to ends along the rope, widths of the rope, less is better\n{}",
             table.text());
}

int run(const Options& options) {
  auto field = weights::load_field(options.range.weights);
  if (!field) return survey::failed(field.error());
  const Gathered gathered = gather(options);
  if (gathered.fitted.empty()) {
    return survey::failed({ErrorCode::kNoEvidence,
                           "tip-fit: expected scenes whose ropes the field shows, got none; raise "
                           "--scenes"});
  }
  auto tips = fit_tips(gathered.fitted, options.rounds);
  print(gathered, tips);
  tips.notes = fmt::format(
      "flowdlo-lab tip-fit, training scenes from {}: {} of wide, {} of several, {} tangled, {} of "
      "thesis, {} "
      "drawn, three in four of each; {} rounds",
      options.range.first, options.range.scenes, options.several, options.tangled, options.thesis,
      options.drawn, options.rounds);
  field->tips = std::move(tips);
  const auto saved = weights::save_field(*field, options.out);
  return saved ? 0 : survey::failed(saved.error());
}

}  // namespace

void add_tip_fit(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "tip-fit", "The network that finds a rope's tips, fitted to scenes beside a field");
  options->range.part = "training";
  strand::add_options(app, options->range);
  app.add_option("--several", options->several, "So many scenes of several ropes as well");
  app.add_option("--tangled", options->tangled, "And so many of several that are looped or coiled");
  app.add_option("--thesis", options->thesis, "So many scenes of the split thesis as well");
  app.add_option("--drawn", options->drawn, "And so many drawn ones");
  app.add_option("--rounds", options->rounds, "Of the fit over all ends")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--out", options->out, "The field's weights with the network, .safetensors")
      ->required();
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
