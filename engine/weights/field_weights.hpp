// FieldWeights: the network of room `field`, as a .safetensors file beside the velocity model's,
// and with it those of room `refine`, and the one by which room `path` links strands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/result.hpp"
#include "weights/link_weights.hpp"
#include "weights/location.hpp"
#include "weights/refine_weights.hpp"
#include "weights/tip_weights.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {

/// Inputs and outputs of the network for each 2 x 2 pixels: seven planes and ten channels of each
/// pixel, rounded up to what kernels take. What is beyond is zero.
inline constexpr int kFieldInputs = 32;
inline constexpr int kFieldOutputs = 48;

/// Channels inside the network; multiples of 16, at most 48, 160 and 448.
struct FieldSizes {
  int fine = 32;    ///< at half the region's size,
  int middle = 48;  ///< at a quarter,
  int coarse = 96;  ///< and at an eighth

  friend bool operator==(const FieldSizes&, const FieldSizes&) = default;
};

struct FieldWeights {
  std::string name;
  std::string training_data;  ///< "none" for seeded noise
  std::string notes;          ///< free text: training command, device, validation table
  FieldSizes sizes;
  std::vector<Tensor> tensors;               ///< exactly field_manifest()'s, in its order
  std::optional<RefineWeights> refine{};     ///< where the file holds that network as well,
  std::optional<LinkWeights> links{};        ///< the one that links its strands,
  std::optional<TipWeights> tips{};          ///< the one that finds tips,
  std::optional<Calibration> calibration{};  ///< and what the gate was fitted to beside this field

  /// The tensor of that name. It must be one of the manifest's.
  [[nodiscard]] const Tensor& at(std::string_view name) const;
};

/// Names and shapes: of each convolution a weight [out, taps, in] and a bias [out], with the batch
/// norm behind it folded in.
[[nodiscard]] std::vector<Expected> field_manifest(const FieldSizes& sizes);

/// Fails with kIo or kBadWeights, listing every mismatch.
[[nodiscard]] Result<FieldWeights> load_field(const std::filesystem::path& file);
[[nodiscard]] Result<FieldWeights> load_field(const Place& place);

/// The same of bytes in memory; `file` is their name.
[[nodiscard]] Result<FieldWeights> parse_field(std::span<const std::uint8_t> bytes,
                                               const std::filesystem::path& file);

/// As f16. Fails with kBadWeights where a value is too large for that, with kIo where the file
/// cannot be written.
[[nodiscard]] Result<void> save_field(const FieldWeights& weights,
                                      const std::filesystem::path& file);

/// Noise of the size that keeps activations as large as inputs: the same values on every machine.
[[nodiscard]] FieldWeights seeded_field(const FieldSizes& sizes, std::uint64_t seed);

}  // namespace flowdlo::weights
