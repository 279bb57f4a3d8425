#include "model_options.hpp"

#include <fmt/format.h>

#include <string>

#include "choice.hpp"
#include "whole_number.hpp"
#include "wide_lavapipe.hpp"

namespace flowdlo::support {
namespace {

void add_prior_options(CLI::App& command, Config& config) {
  command
      .add_option("--prior", config.prior,
                  "What the model refines: thesis (Eq. 3.1-3.7), refined (on the rope's axis), or "
                  "auto, as the weights were trained")
      ->transform(choice<PriorChoice>({{"auto", PriorChoice::kOfWeights},
                                       {"thesis", PriorChoice::kThesis},
                                       {"refined", PriorChoice::kRefined}}))
      ->type_name("KIND");
  command
      .add_option(
          "--gate", config.gate,
          "Who decides between predictions and priors: thesis (Eq. 3.30-3.33), calibrated (a "
          "fitted score), or auto, as the weights were trained")
      ->transform(choice<GateChoice>({{"auto", GateChoice::kOfWeights},
                                      {"thesis", GateChoice::kThesis},
                                      {"calibrated", GateChoice::kCalibrated}}))
      ->type_name("RULE");
  command
      .add_option("--field", config.field,
                  "The strand field, which sees strands that the mask merges, and what refines "
                  "the nodes: auto (where the weights lie beside the model's), strands (the first "
                  "alone) or off")
      ->transform(choice<FieldChoice>({{"auto", FieldChoice::kBeside},
                                       {"strands", FieldChoice::kStrands},
                                       {"off", FieldChoice::kOff}}))
      ->type_name("CHOICE");
  command
      .add_option(
          "--field-on", config.field_device,
          "Where the strand field runs: auto (on a real GPU or on the CPU, whichever a trial "
          "finds faster), cpu, or device (that of --device, untried)")
      ->transform(choice<FieldDevice>({{"auto", FieldDevice::kFaster},
                                       {"cpu", FieldDevice::kCpu},
                                       {"device", FieldDevice::kSame}}))
      ->type_name("PLACE");
  command
      .add_option("--field-weights", config.field_weights,
                  "Of the strand field, .safetensors [those beside the model's]")
      ->type_name("FILE");
  command
      .add_option("--rope-length", config.rope_length_m,
                  "Metres, where the rope's length is known; 0: unknown")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void add_model_options(CLI::App& command, Config& config) {
  command.add_option("--weights", config.weights, "A .fdw file [the one that ships]")
      ->type_name("FILE");
  command
      .add_option("--device", config.device,
                  "auto, vulkan, cpu, part of a device's name, or its UUID")
      ->capture_default_str()
      ->each(widen_lavapipe);
  const auto run_in_full = [&config](const std::string&) { config.quality = Quality::kFull; };
  auto* steps = command.add_option("--steps", config.euler_steps, "Euler steps of the model")
                    ->capture_default_str()
                    ->each(run_in_full)
                    ->check(CLI::Range(1, 64));
  auto* draws = command.add_option("--draws", config.draws, "Gaussian sources a frame")
                    ->capture_default_str()
                    ->each(run_in_full)
                    ->check(CLI::Range(1, 64));
  command
      .add_option(
          "--quality", config.quality,
          fmt::format("full: 10 steps of 4 draws, as the thesis has it; fast: the steps and "
                      "draws that the weights' metadata say lose nothing, and none where "
                      "none was ever chosen; auto: fast, but full with --gate thesis [{}]",
                      config.quality == Quality::kAuto ? "auto" : "full"))
      ->transform(choice<Quality>(
          {{"auto", Quality::kAuto}, {"full", Quality::kFull}, {"fast", Quality::kFast}}))
      ->excludes(steps)
      ->excludes(draws)
      ->type_name("QUALITY");
  command.add_option("--seed", config.seed, "Of the Gaussian sources")
      ->capture_default_str()
      ->check(whole_number());
  command.add_option("--threads", config.threads, "Of the CPU back end; 0: every core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command
      .add_option(
          "--budget", config.budget_ms,
          "Milliseconds that an estimate may take: what would end too late is left out, and "
          "estimate.json says what; 0: no limit")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  add_prior_options(command, config);
}

}  // namespace flowdlo::support
