#include "weights/stored_tensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "weights/half.hpp"
#include "weights/sha256.hpp"

static_assert(std::endian::native == std::endian::little, "weights files are read in place");

namespace flowdlo::weights {
namespace {

constexpr const char* kRemedy = "re-export with the manifest in weights/README.md";

std::size_t element_bytes(DType dtype) {
  switch (dtype) {
    case DType::kF32:
      return 4;
    case DType::kF16:
    case DType::kBf16:
      return 2;
    case DType::kOther:
      return 0;
  }
  return 0;
}

template <class Integer>
std::string shape_text(const std::vector<Integer>& shape) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(shape.size(), kShown); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", shape[i]);
  }
  return fmt::format("[{}{}]", text, shape.size() > kShown ? ", ..." : "");
}

std::string dtype_list(std::span<const DType> dtypes) {
  std::string text;
  for (std::size_t i = 0; i < dtypes.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 == dtypes.size() ? " or " : ", ";
    text += fmt::format("{}{}", separator, name_of(dtypes[i]));
  }
  return text;
}

bool same_shape(const std::vector<int>& expected, const std::vector<std::int64_t>& got) {
  if (expected.empty() && got == std::vector<std::int64_t>{1}) return true;  // gamma
  return std::equal(expected.begin(), expected.end(), got.begin(), got.end());
}

std::size_t count_of(const std::vector<int>& shape) {
  std::size_t count = 1;
  for (const int extent : shape) count *= static_cast<std::size_t>(extent);
  return count;
}

/// Empty when `got` is what the manifest asks for.
std::string tensor_fault(const Expected& expected, const StoredTensor& got,
                         std::span<const DType> dtypes) {
  const bool readable = std::find(dtypes.begin(), dtypes.end(), got.dtype) != dtypes.end();
  if (!readable || !same_shape(expected.shape, got.shape)) {
    return fmt::format("tensor {}: expected {} {}, got {} {}; {}", in_quotes(got.name),
                       shape_text(expected.shape), dtype_list(dtypes), shape_text(got.shape),
                       got.dtype_name, kRemedy);
  }
  const std::size_t bytes = count_of(expected.shape) * element_bytes(got.dtype);
  if (got.bytes.size() == bytes) return {};
  return fmt::format("tensor {}: expected {} bytes for {} {}, got {}; {}", in_quotes(got.name),
                     bytes, shape_text(expected.shape), got.dtype_name, got.bytes.size(), kRemedy);
}

template <class Word, class Convert>
void convert_all(std::span<const std::uint8_t> bytes, std::vector<float>& values, Convert convert) {
  const std::uint8_t* source = bytes.data();
  float* target = values.data();
  const std::size_t count = values.size();
  for (std::size_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, source + i * sizeof(Word), sizeof(Word));
    target[i] = convert(word);
  }
}

void convert(const StoredTensor& tensor, std::vector<float>& values) {
  switch (tensor.dtype) {
    case DType::kF32:
      std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
      break;
    case DType::kF16:
      convert_all<std::uint16_t>(tensor.bytes, values, half_to_float);
      break;
    case DType::kBf16:
      convert_all<std::uint16_t>(tensor.bytes, values, [](std::uint16_t word) {
        return std::bit_cast<float>(std::uint32_t{word} << 16U);
      });
      break;
    case DType::kOther:
      break;
  }
}

/// The largest word without its sign, without a branch: a model has 5.8 million values.
template <class Word>
Word largest_magnitude(std::span<const std::uint8_t> bytes) {
  constexpr Word kMagnitude = std::numeric_limits<Word>::max() >> 1U;
  Word largest = 0;
  for (std::size_t i = 0; i < bytes.size() / sizeof(Word); ++i) {
    Word word;
    std::memcpy(&word, bytes.data() + i * sizeof(Word), sizeof(Word));
    largest = std::max<Word>(largest, word & kMagnitude);
  }
  return largest;
}

/// By the exponents of what is stored.
bool all_finite(const StoredTensor& tensor) {
  switch (tensor.dtype) {
    case DType::kF32:
      return largest_magnitude<std::uint32_t>(tensor.bytes) < 0x7F800000U;
    case DType::kF16:
      return largest_magnitude<std::uint16_t>(tensor.bytes) < 0x7C00U;
    case DType::kBf16:
      return largest_magnitude<std::uint16_t>(tensor.bytes) < 0x7F80U;
    case DType::kOther:
      break;
  }
  return true;  // such a tensor never matches
}

}  // namespace

const char* name_of(DType dtype) {
  switch (dtype) {
    case DType::kF32:
      return "f32";
    case DType::kF16:
      return "f16";
    case DType::kBf16:
      return "bf16";
    case DType::kOther:
      return "other";
  }
  return "other";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 80;
  std::string shown;
  for (const char c : text.substr(0, kShown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return fmt::format("\"{}{}\"", shown, text.size() > kShown ? "..." : "");
}

std::string finiteness_fault(std::string_view name, std::span<const float> values) {
  const auto broken = [](float value) { return !std::isfinite(value); };
  // The exponents alone, without a branch: a model has 5.8 million values.
  std::uint32_t largest = 0;
  for (const float value : values) {
    largest = std::max(largest, std::bit_cast<std::uint32_t>(value) & 0x7FFFFFFFU);
  }
  if (largest < 0x7F800000U) return {};
  const auto first = std::find_if(values.begin(), values.end(), broken);
  return fmt::format("tensor {}: expected finite values, got {} that are not, the first at {}; {}",
                     in_quotes(name), std::count_if(values.begin(), values.end(), broken),
                     first - values.begin(), kRemedy);
}

std::vector<const StoredTensor*> match(const std::vector<StoredTensor>& stored,
                                       const std::vector<Expected>& manifest,
                                       std::span<const DType> dtypes,
                                       std::vector<std::string>& faults) {
  std::map<std::string_view, const StoredTensor*> by_name;
  for (const StoredTensor& tensor : stored) {
    if (by_name.emplace(tensor.name, &tensor).second) continue;
    faults.push_back(
        fmt::format("tensor {}: expected once, got it again; {}", in_quotes(tensor.name), kRemedy));
  }
  std::vector<const StoredTensor*> matched;
  for (const Expected& expected : manifest) {
    const auto found = by_name.find(expected.name);
    std::string fault;
    if (found == by_name.end()) {
      fault = fmt::format("tensor {}: expected {} {}, got none; {}", in_quotes(expected.name),
                          shape_text(expected.shape), dtype_list(dtypes), kRemedy);
      matched.push_back(nullptr);
    } else {
      fault = tensor_fault(expected, *found->second, dtypes);
      matched.push_back(fault.empty() ? found->second : nullptr);
      by_name.erase(found);
    }
    if (!fault.empty()) faults.push_back(fault);
  }
  for (const auto& [name, tensor] : by_name) {
    faults.push_back(fmt::format("tensor {}: expected no tensor of that name, got {} {}; {}",
                                 in_quotes(name), shape_text(tensor->shape), tensor->dtype_name,
                                 kRemedy));
  }
  return matched;
}

void expect_finite(const std::vector<const StoredTensor*>& matched,
                   std::vector<std::string>& faults) {
  for (const StoredTensor* tensor : matched) {
    if (tensor == nullptr || all_finite(*tensor)) continue;
    std::vector<float> values(tensor->bytes.size() / element_bytes(tensor->dtype));
    convert(*tensor, values);
    faults.push_back(finiteness_fault(tensor->name, values));
  }
}

std::vector<Tensor> decode(const std::vector<const StoredTensor*>& matched,
                           std::vector<Expected> manifest) {
  std::vector<Tensor> tensors;
  tensors.reserve(manifest.size());
  for (std::size_t i = 0; i < manifest.size(); ++i) {
    Tensor tensor{std::move(manifest[i].name), std::move(manifest[i].shape), {}};
    if (matched[i] != nullptr) {
      tensor.values.resize(count_of(tensor.shape));
      convert(*matched[i], tensor.values);
    }
    tensors.push_back(std::move(tensor));
  }
  return tensors;
}

std::string digest(const std::vector<const StoredTensor*>& matched) {
  Sha256 sha;
  for (const StoredTensor* tensor : matched) {
    if (tensor != nullptr) sha.update(tensor->bytes);
  }
  return sha.finish();
}

}  // namespace flowdlo::weights
