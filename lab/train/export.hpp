// Export: a checkpoint as a weights file of the engine.
#pragma once

#include <filesystem>
#include <string>

#include "flowdlo/result.hpp"
#include "train/training_state.hpp"
#include "weights/weights.hpp"

namespace flowdlo::train {

/// The averaged weights where there are any, with the metadata of spec section 7. `date` stands in
/// the notes.
[[nodiscard]] weights::Weights to_weights(const TrainingState& state, const std::string& date);

/// `file` ends in .fdw or .safetensors; values as f16 or f32. Fails with kBadInput or kIo.
[[nodiscard]] Result<void> export_weights(const weights::Weights& weights,
                                          const std::filesystem::path& file,
                                          weights::StorageType type);

}  // namespace flowdlo::train
