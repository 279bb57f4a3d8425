// Embedded: the shipped weights within the library, where it was built with them.
#pragma once

#include <cstdint>
#include <span>

namespace flowdlo::weights {

/// Files as they are; both empty in a library without FLOWDLO_EMBED_WEIGHTS. They last as long as
/// the program and lie as aligned as every tensor of theirs asks.
struct Embedded {
  std::span<const std::uint8_t> model;  ///< .fdw
  std::span<const std::uint8_t> field;  ///< .safetensors
};

[[nodiscard]] Embedded embedded();

}  // namespace flowdlo::weights
