#include "train/export.hpp"

#include <fmt/format.h>

#include "evidence/mask_field.hpp"
#include "files/temporary_file.hpp"
#include "flowdlo/weights.hpp"
#include "train/weights_exchange.hpp"

namespace flowdlo::train {

weights::Weights to_weights(const TrainingState& state, const std::string& date) {
  weights::Weights weights;
  auto& metadata = weights.metadata;
  metadata.name = state.recipe.name;
  metadata.version = fmt::format("1-step{}", state.step);
  metadata.training_data = fmt::format("synthetic scenes: {}; SHA-256 of the records {}",
                                       state.data_origin, state.data_sha256);
  metadata.licence = "MIT";
  metadata.notes = fmt::format(
      "command: {}\nseed: {}\nsteps: {} of {}, batch {}\ndevice: {}\ndate: {}\nrecipe: {}\n"
      "validation at the last check, direction matched to the prior's:\n{}",
      state.command, state.recipe.seed, state.step, state.recipe.optimizer.steps,
      state.recipe.optimizer.batch, state.device, date, to_json(state.recipe), state.validation);
  metadata.mean = state.norm.mean;
  metadata.scale = state.norm.scale;
  metadata.trained = true;
  metadata.variant = state.recipe.variant;
  metadata.variant.local_features_version = evidence::kLocalFeaturesVersion;
  weights.tensors = tensors_of(state.best());
  return weights;
}

Result<void> export_weights(const weights::Weights& weights, const std::filesystem::path& file,
                            weights::StorageType type) {
  if (file.extension() == ".fdw") return weights::save(weights, file, type);
  if (file.extension() != ".safetensors") {
    return Error{ErrorCode::kBadInput, fmt::format("{}: expected a name that ends in .fdw or "
                                                   ".safetensors",
                                                   file.string())};
  }
  const auto folder = files::Folder::open(file.parent_path());
  if (!folder) return folder.error();
  const auto between = files::TemporaryFile::create(*folder, files::TemporaryKind::kSingle,
                                                    file.filename().string());
  if (!between) return between.error();
  const auto place = file.parent_path() / between->name();
  if (auto saved = weights::save(weights, place, type); !saved) return saved;
  return export_safetensors(place, file);
}

}  // namespace flowdlo::train
