// Weights files: what is in them, and their way to and from .safetensors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "flowdlo/export.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

struct TensorInfo {
  std::string name;        ///< PyTorch's, spec section 6: "encoder.0.qkv.weight"
  std::vector<int> shape;  ///< outermost first
  std::string dtype;       ///< "f32" or "f16"
};

struct WeightsInfo {
  std::map<std::string, std::string> metadata;  ///< field name to value, as in the schema
  std::vector<TensorInfo> tensors;              ///< in the manifest's order
  std::int64_t parameters = 0;
  std::string sha256;  ///< of the tensors' bytes, hexadecimal, verified
};

/// Reads and verifies `file`; empty: the one that Config::weights left empty stands for. Fails with
/// kIo or kBadWeights, listing every mismatch.
[[nodiscard]] FLOWDLO_EXPORT Result<WeightsInfo> inspect_weights(const std::filesystem::path& file);

/// .fdw to .safetensors, metadata included. Fails with kIo or kBadWeights; no partial file stays.
[[nodiscard]] FLOWDLO_EXPORT Result<void> export_safetensors(const std::filesystem::path& weights,
                                                             const std::filesystem::path& output);

/// Writes `weights` again with the K and D that quality fast stands for (Config::quality): 1..64,
/// or 0 for those of full. `output` may be `weights`. Fails with kIo or kBadWeights.
[[nodiscard]] FLOWDLO_EXPORT Result<void> set_fast_quality(const std::filesystem::path& weights,
                                                           int steps, int draws,
                                                           const std::filesystem::path& output);

/// .safetensors (tensor names of spec section 6; metadata keys of the schema) to .fdw.
/// Fails with kIo or kBadWeights; no partial file stays.
[[nodiscard]] FLOWDLO_EXPORT Result<void> import_safetensors(const std::filesystem::path& input,
                                                             const std::filesystem::path& weights);

}  // namespace flowdlo
