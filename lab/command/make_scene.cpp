// flowdlo-lab make-scene OUT_DIR [--kind K] [--seed S] [--ropes N [--labels]]: one synthetic frame
// folder, of one rope with its truth, or of several, with their labels where these are asked for.
#include <CLI/App.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/frame_folder.hpp"
#include "scene/ropes.hpp"
#include "scene/scene.hpp"
#include "terminal.hpp"
#include "whole_number.hpp"

namespace {

using namespace flowdlo;
using support::ExitCode;

constexpr double kDepthScale_m = 0.001;
constexpr int kMostDrawn = 9;

struct Options {
  std::filesystem::path out;
  std::string kind;
  std::uint64_t seed = 0;
  int ropes = 1;
  bool labels = false;
};

/// "coil, hairpin": every kind of one rope, or of several.
template <class Kind>
std::string kinds(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    if (!all.empty()) all += ", ";
    all += name_of(static_cast<Kind>(i));
  }
  return all;
}

ExitCode refused(const Options& options, const std::string& known) {
  support::tell_error("make-scene: --kind: expected one of {} for {}, got \"{}\"\n", known,
                      options.ropes == 1 ? "one rope" : "several ropes", options.kind);
  return ExitCode::kUsage;
}

ExitCode told(const Options& options, const Result<void>& saved, std::string_view kind) {
  if (!saved) {
    support::tell_error("{}\n", saved.error().message);
    return ExitCode::kFailed;
  }
  support::tell("{}: {}, seed {}\n", options.out.string(), kind, options.seed);
  return ExitCode::kDone;
}

ExitCode make_one(const Options& options) {
  const auto kind = lab::kind_of(options.kind.empty() ? "one-crossing" : options.kind);
  if (!kind) return refused(options, kinds<lab::Kind>(lab::kKinds));
  const lab::Scene scene = lab::make_scene(*kind, options.seed);
  const auto saved = save_frame_folder(options.out, scene.frame(), kDepthScale_m, &scene.truth);
  return told(options, saved, name_of(*kind));
}

ExitCode make_several(const Options& options) {
  const auto kind = lab::ropes_kind_of(options.kind.empty() ? "crossing" : options.kind);
  if (!kind) return refused(options, kinds<lab::RopesKind>(lab::kRopesKinds));
  const auto scene = lab::make_ropes(*kind, options.ropes, options.seed);
  const auto saved = save_frame_folder(options.out, scene.frame(options.labels), kDepthScale_m);
  return told(options, saved, name_of(*kind));
}

}  // namespace

namespace flowdlo::lab {

void add_make_scene(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(program, "make-scene", "Draw a scene of one rope or several");
  app.add_option("OUT", options->out, "The frame folder")->required();
  app.add_option(
         "--kind", options->kind,
         "Of one rope: " + kinds<Kind>(kKinds) + "; of several: " + kinds<RopesKind>(kRopesKinds))
      ->type_name("KIND");
  app.add_option("--seed", options->seed, "Of the scene")
      ->capture_default_str()
      ->check(support::whole_number());
  auto* ropes =
      app.add_option("--ropes", options->ropes, "How many; several have no truth in the folder")
          ->capture_default_str()
          ->check(CLI::Range(1, kMostDrawn));
  app.add_flag("--labels", options->labels, "The mask says which of several ropes each pixel shows")
      ->needs(ropes);
  app.callback([options, &exit_code] {
    exit_code = options->ropes == 1 ? make_one(*options) : make_several(*options);
  });
}

}  // namespace flowdlo::lab
