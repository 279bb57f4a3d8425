// The .npy format, version 1.0: one little-endian array in C order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace flowdlo::tools {

/// The bytes of a file that numpy.load gives back with dtype float32, bool or uint8 and `shape`.
/// The product of `shape` must be the number of values.
[[nodiscard]] std::string npy_f32(std::span<const float> values, const std::vector<int>& shape);
[[nodiscard]] std::string npy_bool(std::span<const std::uint8_t> values,
                                   const std::vector<int>& shape);
[[nodiscard]] std::string npy_u8(std::span<const std::uint8_t> values,
                                 const std::vector<int>& shape);

}  // namespace flowdlo::tools
