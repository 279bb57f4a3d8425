#include "estimator/opening.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "estimator/device_choice.hpp"

namespace flowdlo::estimator {
namespace {

/// A rope rarely covers more of an image than this; a denser mask makes the sampler grow once.
constexpr int kCloudShare = 4;

}  // namespace

Config resolved(const Config& config, const weights::Metadata& metadata) {
  Config result = config;
  const Config full;
  if (config.quality == Quality::kAuto) {
    const bool usual = config.euler_steps == full.euler_steps && config.draws == full.draws;
    const bool fast = usual && config.gate != GateChoice::kThesis;
    result.quality = fast ? Quality::kFast : Quality::kFull;
  }
  if (result.quality == Quality::kFull) return result;
  result.euler_steps = metadata.fast_steps > 0 ? metadata.fast_steps : full.euler_steps;
  result.draws = metadata.fast_draws > 0 ? metadata.fast_draws : full.draws;
  return result;
}

flow::SamplerConfig sampler_config(const Config& config) {
  const int pixels = config.max_width * config.max_height;
  return {.draws = config.draws,
          .steps = config.euler_steps,
          .seed = config.seed,
          .capacity = {.cloud_points = pixels / kCloudShare,
                       .field_texels = pixels / 4,
                       .image_pixels = pixels}};
}

flow::WeightsSource source_of(std::shared_ptr<const weights::KeptFile> model) {
  return [model = std::move(model)] {
    return std::make_shared<const weights::Weights>(model->decoded());
  };
}

Result<FieldFile> open_field(const Config& config, const weights::Place& beside) {
  if (config.field == FieldChoice::kOff) return FieldFile{};
  const auto place =
      config.field_weights.empty() ? beside : weights::Place{config.field_weights, {}};
  if (place.file.empty()) return FieldFile{};
  auto loaded = weights::load_field(place);
  if (!loaded) return loaded.error();
  FieldFile file;
  if (loaded->refine && config.field != FieldChoice::kStrands) {
    auto refine =
        refine::Network::create(*loaded->refine, cpu_back_end(1).make_program, loaded->tips);
    if (!refine) return refine.error();
    file.refine = *std::move(refine);
  }
  loaded->refine.reset();
  loaded->tips.reset();
  file.calibration = std::move(loaded->calibration);
  file.field = std::make_shared<const weights::FieldWeights>(*std::move(loaded));
  return file;
}

void return_free_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

weights::PriorKind prior_kind(const Config& config, const weights::Metadata& metadata) {
  switch (config.prior) {
    case PriorChoice::kThesis:
      return weights::PriorKind::kThesis;
    case PriorChoice::kRefined:
      return weights::PriorKind::kRefined;
    case PriorChoice::kOfWeights:
      break;
  }
  return metadata.variant.prior_kind;
}

Result<std::optional<gate::Fitted>> open_gate(const Config& config, const weights::KeptFile& model,
                                              const std::optional<weights::Calibration>& of_field) {
  const bool suits = model.calibration() && model.metadata().trained &&
                     prior_kind(config, model.metadata()) == weights::PriorKind::kRefined;
  const bool asked = config.gate == GateChoice::kCalibrated;
  if (config.gate == GateChoice::kThesis || (!asked && !suits)) {
    return std::optional<gate::Fitted>();
  }
  if (!model.calibration()) {
    return Error{
        ErrorCode::kBadWeights,
        fmt::format("Estimator: expected weights that a calibrated gate was fitted to, got "
                    "\"{}\" without a section \"calibration\"; fit one with flowdlo-lab "
                    "gate-fit, or leave Config::gate to the weights",
                    model.metadata().name)};
  }
  return gate::Fitted::of_weights(model.calibration(), of_field);
}

}  // namespace flowdlo::estimator
