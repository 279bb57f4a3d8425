// StoredTensor: one tensor as a file holds it, before anything about it is believed.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

enum class DType { kF32, kF16, kBf16, kOther };

struct StoredTensor {
  std::string_view name;
  std::vector<std::int64_t> shape;
  DType dtype = DType::kOther;
  std::string dtype_name;               ///< as the file says it; for messages
  std::span<const std::uint8_t> bytes;  ///< little-endian, row-major
};

/// "f32", "f16", "bf16" or "other".
[[nodiscard]] const char* name_of(DType dtype);

/// `text` in quotes, made fit for a message: at most 80 characters, printable ASCII.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The tensors of a manifest, found in `stored` by name, in the manifest's order; null where one is
/// missing or unfit. Every mismatch of names, shapes, dtypes and sizes goes to `faults`. `dtypes`
/// lists what the file's kind may hold.
[[nodiscard]] std::vector<const StoredTensor*> match(const std::vector<StoredTensor>& stored,
                                                     const std::vector<Expected>& manifest,
                                                     std::span<const DType> dtypes,
                                                     std::vector<std::string>& faults);

/// Values of matched tensors that are not finite go to `faults`.
void expect_finite(const std::vector<const StoredTensor*>& matched,
                   std::vector<std::string>& faults);

/// The values of tensors that matched a manifest, as f32, whatever they are.
[[nodiscard]] std::vector<Tensor> decode(const std::vector<const StoredTensor*>& matched,
                                         std::vector<Expected> manifest);

/// SHA-256 of the matched tensors' bytes, one after another.
[[nodiscard]] std::string digest(const std::vector<const StoredTensor*>& matched);

/// One line when values are not finite, otherwise empty.
[[nodiscard]] std::string finiteness_fault(std::string_view name, std::span<const float> values);

}  // namespace flowdlo::weights
