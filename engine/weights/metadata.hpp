// Metadata as text: the fields of the schema by name, as .safetensors and `weights info` show them.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

/// The local features that this library computes; a file may name versions 1 up to this one.
inline constexpr int kNewestLocalFeatures = 1;

/// Field names of the schema (all but sha256) to values; numbers so that they read back exactly.
[[nodiscard]] std::map<std::string, std::string> to_fields(const Metadata& metadata);

/// The reverse. Missing or unreadable fields go to `faults`, and their values stay at the defaults.
/// Fields of other names are left alone; `notes`, `fast_steps` and
/// `fast_draws` may be missing.
[[nodiscard]] Metadata from_fields(const std::map<std::string, std::string>& fields,
                                   std::vector<std::string>& faults);

/// One line a field whose value no model can have.
[[nodiscard]] std::vector<std::string> faults(const Metadata& metadata);

/// `variant` with fields that decide about the manifest put right, so that tensors can be checked
/// whatever the metadata holds.
[[nodiscard]] Variant usable(const Variant& variant);

[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace flowdlo::weights
