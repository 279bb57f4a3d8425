// Weights: the tensors of one velocity model and what is known about them. Spec sections 6 and 7.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/result.hpp"
#include "weights/variant.hpp"

namespace flowdlo::weights {

struct Metadata {
  std::string name;
  std::string version;
  std::string training_data;  ///< "none" for seeded noise
  std::string licence;
  std::string notes;            ///< free text: training command, device, date, validation table
  std::array<float, 3> mean{};  ///< mu of Eq. (3.8), metres; used by global normalisation
  float scale = 1;              ///< sigma_iso of Eq. (3.9), metres
  bool trained = false;         ///< false: seeded noise
  int fast_steps = 0;           ///< K of quality fast, measured to lose nothing; 0: as full
  int fast_draws = 0;           ///< ... and D
  Variant variant;
};

struct Tensor {
  std::string name;
  std::vector<int> shape;     ///< outermost first; a scalar's is empty
  std::vector<float> values;  ///< f32 in memory whatever the file holds
};

/// The tensor of that name, which must be there.
[[nodiscard]] const Tensor& named(std::span<const Tensor> tensors, std::string_view name);

struct Expected {
  std::string name;
  std::vector<int> shape;
};

/// What the calibrated gate was fitted to: weights/calibration.hpp.
struct Calibration {
  std::string notes;            ///< free text: command, scenes
  std::vector<Tensor> tensors;  ///< exactly calibration_manifest()'s, in its order
};

/// Names and shapes of a variant's tensors, in the order of spec section 6.
[[nodiscard]] std::vector<Expected> manifest(const Variant& variant);

struct Weights {
  Metadata metadata;
  std::vector<Tensor> tensors;               ///< exactly the manifest's, in its order
  std::optional<Calibration> calibration{};  ///< where the file has that section

  /// The tensor of that name. It must be one of the manifest's.
  [[nodiscard]] const Tensor& at(std::string_view name) const;
};

/// One line a fault (missing, unknown, wrong shape, not finite); empty when all is well.
[[nodiscard]] std::vector<std::string> faults(const Weights& weights);

enum class StorageType { kF32, kF16 };

/// Reads and verifies a .fdw file. Fails with kIo or kBadWeights, listing every mismatch.
[[nodiscard]] Result<Weights> load(const std::filesystem::path& file);

/// Writes a .fdw file under a temporary name, then renames it.
[[nodiscard]] Result<void> save(const Weights& weights, const std::filesystem::path& file,
                                StorageType type = StorageType::kF16);

/// Noise of the size that PyTorch's default initialisation has, from Philox: the same values on
/// every machine. For tests, and as a stand-in until a model has been trained.
[[nodiscard]] Weights seeded(const Variant& variant, std::uint64_t seed);

}  // namespace flowdlo::weights
