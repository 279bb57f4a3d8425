#include "npy.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstddef>

namespace flowdlo::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "npy.cpp writes the bytes as they lie");

std::string tuple_of(const std::vector<int>& shape) {
  std::string text = "(";
  for (const int side : shape) text += fmt::format("{}, ", side);
  if (shape.size() > 1) text.resize(text.size() - 2);
  if (shape.size() == 1) text.pop_back();  // (64,)
  return text + ")";
}

std::string header(const char* dtype, const std::vector<int>& shape) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreamble = 10;  // magic, version and length
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", dtype,
                                 tuple_of(shape));
  const std::size_t unpadded = kPreamble + text.size() + 1;
  text.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(text.size() & 0xFF);
  bytes += static_cast<char>(text.size() >> 8);
  return bytes + text;
}

template <class Value>
std::string npy(const char* dtype, std::span<const Value> values, const std::vector<int>& shape) {
  std::size_t count = 1;
  for (const int side : shape) count *= static_cast<std::size_t>(side);
  assert(count == values.size());
  return header(dtype, shape)
      .append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

}  // namespace

std::string npy_f32(std::span<const float> values, const std::vector<int>& shape) {
  return npy("<f4", values, shape);
}

std::string npy_bool(std::span<const std::uint8_t> values, const std::vector<int>& shape) {
  return npy("|b1", values, shape);
}

std::string npy_u8(std::span<const std::uint8_t> values, const std::vector<int>& shape) {
  return npy("|u1", values, shape);
}

}  // namespace flowdlo::tools
