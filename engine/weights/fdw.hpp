// Fdw: a weights file with all that the public structs leave out, for inspection and exchange.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

inline constexpr std::size_t kDataAlignment = 64;  ///< force_align of Tensor.data in the schema

struct FdwFile {
  Weights weights;
  std::vector<StorageType> types;  ///< one for each tensor
  std::string sha256;              ///< of the tensors' bytes as stored; verified
};

/// Reads and verifies. Fails with kIo or kBadWeights, listing every mismatch.
[[nodiscard]] Result<FdwFile> read_fdw(const std::filesystem::path& file);

/// The same of bytes in memory, which are aligned for every scalar type; `file` is their name.
[[nodiscard]] Result<FdwFile> parse_fdw(std::span<const std::uint8_t> bytes,
                                        const std::filesystem::path& file);

/// What a .safetensors file holds, as a .fdw file would hold it. Fails with kBadWeights, listing
/// every mismatch; `file` is the name of `bytes`.
[[nodiscard]] Result<FdwFile> parse_exchanged(std::span<const std::uint8_t> bytes,
                                              const std::filesystem::path& file);

/// Writes with a storage type for each tensor. Fails with kBadWeights (faults of `weights`, values
/// beyond f16) or kIo; no partial file stays.
[[nodiscard]] Result<void> write_fdw(const Weights& weights, const std::vector<StorageType>& types,
                                     const std::filesystem::path& file);

/// A tensor's values as stored, little-endian. Values that f16 cannot hold go to `faults`.
[[nodiscard]] std::vector<std::uint8_t> encode(const Tensor& tensor, StorageType type,
                                               std::vector<std::string>& faults);

}  // namespace flowdlo::weights
