// Location: where the weights lie that Config leaves unnamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "flowdlo/result.hpp"
#include "weights/embedded.hpp"

namespace flowdlo::weights {

/// The environment variable that names a .fdw file in place of the shipped one.
inline constexpr const char* kVariable = "FLOWDLO_WEIGHTS";

/// The content of a weights file: to be read from `file`, or within the library.
struct Place {
  std::filesystem::path file;
  std::span<const std::uint8_t> bytes;  ///< not empty: the content; `file` names it in messages
};

/// A model and the strand field that belongs to it.
struct Location {
  Place model;
  Place field;  ///< without a file: there is none
};

/// `model`, and the `field.safetensors` in its folder where there is one.
[[nodiscard]] Location located(const std::filesystem::path& model);

/// What decides where weights are that nobody named.
struct Surroundings {
  const char* named = nullptr;  ///< the value of kVariable; null or empty: not set
  Embedded embedded;
  std::vector<std::filesystem::path> programs;  ///< files beside which weights may be installed
};

/// The file that the variable names; else those within the library; else share/flowdlo/flowdlo.fdw
/// beside one of the programs: in its folder, or up to three above. Where anybody may write is not
/// looked. Fails with kBadWeights, listing where it looked.
[[nodiscard]] Result<Location> default_location(const Surroundings& surroundings);

/// With this process's variable, this library's weights, and beside the library and the program.
[[nodiscard]] Result<Location> default_location();

}  // namespace flowdlo::weights
