// Safetensors: 8 bytes header length (little-endian), a JSON header, the tensors' bytes.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {

struct Safetensors {
  std::map<std::string, std::string> metadata;  ///< the header's __metadata__
  std::vector<std::string> names;               ///< what the tensors' names view
  std::vector<StoredTensor> tensors;            ///< views into the bytes that were parsed
};

/// Takes `bytes` apart. Headers that are no JSON of the format's form, offsets that leave the file,
/// overlap, leave gaps or disagree with shape and dtype go to `faults`, all of them.
[[nodiscard]] Safetensors parse_safetensors(std::span<const std::uint8_t> bytes,
                                            std::vector<std::string>& faults);

/// Length and header for tensors whose bytes follow one another in the given order.
[[nodiscard]] std::string safetensors_header(const std::map<std::string, std::string>& metadata,
                                             const std::vector<StoredTensor>& tensors);

}  // namespace flowdlo::weights
