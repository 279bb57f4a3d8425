#include "vulkan/dense_layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "weights/half.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kNarrowInputs = 8;
constexpr int kHeadOutputs = 4;

Packing packing_of(GemmFamily family, int out, int in, std::span<const float> weight) {
  if (out == ops::kWidth && in >= 1 && in <= kNarrowInputs) return Packing::kNarrow;
  if (in == ops::kWidth && out >= 3 && out <= kHeadOutputs) return Packing::kHead;
  const int depth = family == GemmFamily::kSimd ? 16 : 64;
  if (out % kColumns != 0 || in % depth != 0 || in <= 0) return Packing::kNone;
  if (family == GemmFamily::kSimd) return Packing::kPanels;
  return family == GemmFamily::kMatrix || are_halves(weight) ? Packing::kHalves : Packing::kRows;
}

/// [rows, columns] in the corner of [padded_rows, padded_columns].
std::vector<float> padded(std::span<const float> values, int rows, int columns, int padded_rows,
                          int padded_columns) {
  std::vector<float> result(static_cast<std::size_t>(padded_rows) * padded_columns, 0.0F);
  for (int row = 0; row < rows; ++row) {
    const auto source = values.subspan(static_cast<std::size_t>(row) * columns, columns);
    std::copy(source.begin(), source.end(),
              result.begin() + static_cast<std::ptrdiff_t>(row) * padded_columns);
  }
  return result;
}

constexpr std::uint32_t kSignBit = 0x80000000U;
constexpr std::uint32_t kSmallestOfPair = 0x30000000U;  // 2^-31
constexpr std::uint32_t kBeyondPair = 0x40000000U;      // 2
constexpr int kSpareBits = 13;                          // of a float's significand

/// Two weights in a word: see first_of and second_of in the shader.
std::uint32_t pair_of(float first, float second) {
  const auto rest = [](float value) {
    const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & ~kSignBit;
    return std::max(magnitude, kSmallestOfPair) - kSmallestOfPair;
  };
  const std::uint32_t low = rest(second) >> kSpareBits;
  return (std::bit_cast<std::uint32_t>(first) & kSignBit) | rest(first) |
         (std::bit_cast<std::uint32_t>(second) & kSignBit) >> 1U | (low >> 13U) << 28U |
         (low & 0x1FFFU);
}

/// Two halves in the place of each float.
std::vector<float> in_pairs(const std::vector<std::uint16_t>& halves) {
  std::vector<float> pairs(halves.size() / 2);
  std::memcpy(pairs.data(), halves.data(), pairs.size() * sizeof(float));
  return pairs;
}

}  // namespace

std::vector<float> pack_panels(std::span<const float> weight, int out, int in, int panel) {
  constexpr int kBlock = 8;  // columns read side by side: each stays in the cache
  assert(out % panel == 0);
  std::vector<float> packed(weight.size());
  for (int first = 0; first < out; first += kBlock) {
    const std::size_t start = static_cast<std::size_t>(first / panel) * (in / 4) * panel;
    float* const to = packed.data() + (start + static_cast<std::size_t>(first % panel)) * 4;
    const float* const from = weight.data() + static_cast<std::size_t>(first) * in;
    for (int k = 0; k < in; k += 4) {
      for (int column = 0; column < kBlock; ++column) {
        const float* const four = from + static_cast<std::ptrdiff_t>(column) * in + k;
        std::copy_n(four, 4, to + (static_cast<std::ptrdiff_t>(k) / 4 * panel + column) * 4);
      }
    }
  }
  return packed;
}

bool fit_pairs(std::span<const float> weight) {
  bool all = true;
  for (const float value : weight) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t magnitude = bits & ~kSignBit;
    const bool in_range = magnitude >= kSmallestOfPair && magnitude < kBeyondPair;
    all &= magnitude == 0 || (in_range && bits << (32 - kSpareBits) == 0);
  }
  return all;
}

std::vector<float> pack_pairs(std::span<const float> weight, int out, int in, int panel) {
  assert(fit_pairs(weight));
  std::vector<float> packed = pack_panels(weight, out, in, panel);
  for (std::size_t i = 0; i < packed.size() / 8; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      packed[i * 4 + k] = std::bit_cast<float>(pair_of(packed[i * 8 + k], packed[i * 8 + 4 + k]));
    }
  }
  packed.resize(packed.size() / 2);
  packed.shrink_to_fit();
  return packed;
}

std::vector<float> pack_halves(std::span<const float> weight) {
  std::vector<std::uint16_t> halves(weight.size());
  std::transform(weight.begin(), weight.end(), halves.begin(), weights::float_to_half);
  return in_pairs(halves);
}

bool are_halves(std::span<const float> weight) {
  bool all = true;
  for (const float value : weight) all &= weights::is_half(value);
  return all;
}

DenseLayer keep_layer(Plan& plan, std::string_view name, int out, int in,
                      std::span<const float> weight, std::span<const float> bias) {
  assert(weight.size() == static_cast<std::size_t>(out) * in);
  assert(bias.size() == static_cast<std::size_t>(out));
  DenseLayer layer{.packing = packing_of(plan.gemm().family, out, in, weight),
                   .in = in,
                   .out = out,
                   .weight = {},
                   .bias = {}};
  const auto keep = [&](int rows, int columns, std::vector<float> content) {
    return plan.tensor(Home::kDevice, name, rows, columns, std::move(content));
  };
  const int panel = plan.lanes() * plan.gemm().columns;
  switch (layer.packing) {
    case Packing::kPanels:
      layer.pairs = fit_pairs(weight);
      layer.weight = layer.pairs ? keep(out, in / 2, pack_pairs(weight, out, in, panel))
                                 : keep(out, in, pack_panels(weight, out, in, panel));
      layer.bias = keep(1, out, {bias.begin(), bias.end()});
      break;
    case Packing::kRows:
      layer.weight = keep(out, in, {weight.begin(), weight.end()});
      layer.bias = keep(1, out, {bias.begin(), bias.end()});
      break;
    case Packing::kHalves:
      layer.weight = keep(out, in / 2, pack_halves(weight));
      layer.bias = keep(1, out, {bias.begin(), bias.end()});
      break;
    case Packing::kNarrow:
      layer.weight = keep(out, kNarrowInputs, padded(weight, out, in, out, kNarrowInputs));
      layer.bias = keep(1, out, {bias.begin(), bias.end()});
      break;
    case Packing::kHead:
      layer.weight = keep(kHeadOutputs, in, padded(weight, out, in, kHeadOutputs, in));
      layer.bias = keep(1, kHeadOutputs, padded(bias, 1, out, 1, kHeadOutputs));
      break;
    case Packing::kNone:
      plan.fault(
          fmt::format("layer \"{}\": expected [256, 1..8], [3..4, 256] or [256 n, 64 m], "
                      "got [{}, {}]",
                      name, out, in));
      break;
  }
  return layer;
}

}  // namespace flowdlo::vulkan
