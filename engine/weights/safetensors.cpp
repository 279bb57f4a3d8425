#include "weights/safetensors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "json/parse.hpp"

namespace flowdlo::weights {
namespace {

using json::Value;

constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kLargestHeader = std::size_t{1} << 20U;  // ours has 12 kB
constexpr int kDeepest = 3;                                    // header, tensor, shape
constexpr std::size_t kMostTensors = 1024;
constexpr const char* kRemedy = "write the file again";

struct Range {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

std::string tensor_fault(std::string_view name, std::string_view rest) {
  return fmt::format("tensor {}: {}; {}", in_quotes(name), rest, kRemedy);
}

DType dtype_of(std::string_view name) {
  if (name == "F32") return DType::kF32;
  if (name == "F16") return DType::kF16;
  if (name == "BF16") return DType::kBf16;
  return DType::kOther;
}

const char* format_name(DType dtype) { return dtype == DType::kF16 ? "F16" : "F32"; }

/// The header as JSON, or nothing. Keys given twice are noted.
std::optional<Value> parse_header(std::string_view text, std::vector<std::string>& faults) {
  json::Parsed header = json::parse(text);
  for (const std::string& key : header.twice) {
    faults.push_back(tensor_fault(key, "expected once in the header, got it again"));
  }
  if (header.depth > kDeepest) {
    faults.push_back(fmt::format("header: expected at most {} levels of nesting, got more; {}",
                                 kDeepest, kRemedy));
    return std::nullopt;
  }
  if (!header.fine || !header.value.is_object()) {
    faults.push_back(
        fmt::format("header: expected a JSON object in UTF-8, got {} bytes that are "
                    "none; give a .safetensors file",
                    text.size()));
    return std::nullopt;
  }
  return std::move(header.value);
}

void read_metadata(const Value& entry, Safetensors& result, std::vector<std::string>& faults) {
  if (!entry.is_object()) {
    faults.push_back(fmt::format("header: expected __metadata__ to be an object, got {}; {}",
                                 json::name_of(entry.kind), kRemedy));
    return;
  }
  for (const auto& [key, value] : entry.members) {
    if (value.is_string()) {
      result.metadata[key] = value.string;
    } else {
      faults.push_back(fmt::format("metadata {}: expected a string, got {}; {}", in_quotes(key),
                                   json::name_of(value.kind), kRemedy));
    }
  }
}

/// A whole number from 0 to `most`, which a double holds exactly: a file's size, or less.
std::optional<std::uint64_t> whole_of(const Value& value, std::uint64_t most) {
  const bool fits = value.is_number() && value.whole && value.number >= 0 &&
                    value.number <= static_cast<double>(most);
  return fits ? std::optional(static_cast<std::uint64_t>(value.number)) : std::nullopt;
}

std::optional<std::vector<std::int64_t>> shape_of(const Value& entry) {
  const Value* const found = entry.find("shape");
  if (found == nullptr || !found->is_array()) return std::nullopt;
  std::vector<std::int64_t> shape;
  for (const Value& extent : found->elements) {
    const auto whole = whole_of(extent, std::numeric_limits<std::int32_t>::max());
    if (!whole) return std::nullopt;
    shape.push_back(static_cast<std::int64_t>(*whole));
  }
  return shape;
}

std::optional<Range> range_of(const Value& entry, std::uint64_t available) {
  const Value* const found = entry.find("data_offsets");
  if (found == nullptr || found->elements.size() != 2) return std::nullopt;
  const auto begin = whole_of(found->elements[0], available);
  const auto end = whole_of(found->elements[1], available);
  if (!begin || !end || *begin > *end) return std::nullopt;
  return Range{*begin, *end};
}

/// One tensor of the header; its bytes are left for the caller. Null range: a fault was noted.
std::optional<Range> read_tensor(const Value& entry, std::uint64_t available, StoredTensor& tensor,
                                 std::vector<std::string>& faults) {
  if (!entry.is_object()) {
    faults.push_back(tensor_fault(tensor.name, "expected an object in the header"));
    return std::nullopt;
  }
  const Value* const dtype = entry.find("dtype");
  const bool named = dtype != nullptr && dtype->is_string();
  const auto shape = shape_of(entry);
  const auto range = range_of(entry, available);
  if (!named) faults.push_back(tensor_fault(tensor.name, "expected a dtype that is a string"));
  if (!shape) {
    faults.push_back(tensor_fault(tensor.name, "expected a shape of whole numbers from 0 up"));
  }
  if (!range) {
    faults.push_back(tensor_fault(
        tensor.name, fmt::format("expected data_offsets [begin, end] within {} bytes", available)));
  }
  if (!named || !shape || !range) return std::nullopt;
  const std::string& name = dtype->string;
  tensor.dtype = dtype_of(name);
  tensor.dtype_name = tensor.dtype == DType::kOther ? in_quotes(name) : name_of(tensor.dtype);
  tensor.shape = *shape;
  return range;
}

void check_ranges(std::vector<std::pair<Range, std::string>> ranges, std::uint64_t available,
                  std::vector<std::string>& faults) {
  std::sort(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) {
    return std::pair{a.first.begin, a.first.end} < std::pair{b.first.begin, b.first.end};
  });
  std::uint64_t reached = 0;
  for (const auto& [range, name] : ranges) {
    if (range.begin != reached) {
      faults.push_back(
          tensor_fault(name, fmt::format("expected its bytes to begin at {}, got {} ({})", reached,
                                         range.begin, range.begin < reached ? "overlap" : "gap")));
    }
    reached = std::max(reached, range.end);
  }
  if (reached != available) {
    faults.push_back(fmt::format("tensors: expected {} bytes in all, got {} bytes of data; {}",
                                 reached, available, kRemedy));
  }
}

void read_tensors(const Value& header, std::span<const std::uint8_t> data, Safetensors& result,
                  std::vector<std::string>& faults) {
  std::vector<std::pair<Range, std::string>> ranges;
  bool complete = true;
  result.names.reserve(header.members.size());  // the tensors' names are views of these
  for (const auto& [key, entry] : header.members) {
    if (key == "__metadata__") continue;
    result.names.push_back(key);
    StoredTensor tensor;
    tensor.name = result.names.back();
    const auto range = read_tensor(entry, data.size(), tensor, faults);
    complete = complete && range.has_value();
    if (!range) continue;
    tensor.bytes = data.subspan(range->begin, range->end - range->begin);
    ranges.emplace_back(*range, key);
    result.tensors.push_back(std::move(tensor));
  }
  if (complete) check_ranges(std::move(ranges), data.size(), faults);
}

}  // namespace

std::string safetensors_header(const std::map<std::string, std::string>& metadata,
                               const std::vector<StoredTensor>& tensors) {
  std::string fields;
  for (const auto& [key, value] : metadata) {
    fields +=
        fmt::format("{}{}:{}", fields.empty() ? "" : ",", json::escaped(key), json::escaped(value));
  }
  std::string text = "{\"__metadata__\":{" + fields + "}";
  std::size_t offset = 0;
  for (const StoredTensor& tensor : tensors) {
    const std::size_t end = offset + tensor.bytes.size();
    text += fmt::format(R"(,{}:{{"dtype":"{}","shape":[{}],"data_offsets":[{},{}]}})",
                        json::escaped(tensor.name), format_name(tensor.dtype),
                        fmt::join(tensor.shape, ","), offset, end);
    offset = end;
  }
  text += '}';
  text.resize((text.size() + kLengthBytes - 1) / kLengthBytes * kLengthBytes, ' ');
  const std::uint64_t length = text.size();
  std::string result(kLengthBytes, '\0');
  std::memcpy(result.data(), &length, kLengthBytes);
  return result + text;
}

Safetensors parse_safetensors(std::span<const std::uint8_t> bytes,
                              std::vector<std::string>& faults) {
  Safetensors result;
  std::uint64_t length = 0;
  if (bytes.size() >= kLengthBytes) std::memcpy(&length, bytes.data(), kLengthBytes);
  const std::size_t rest = bytes.size() - std::min(bytes.size(), kLengthBytes);
  if (length == 0 || length > std::min(rest, kLargestHeader)) {
    faults.push_back(
        fmt::format("header: expected 1 to {} bytes, got a length of {} in a file of {} bytes; "
                    "give a .safetensors file",
                    std::min(rest, kLargestHeader), length, bytes.size()));
    return result;
  }
  const auto* text = reinterpret_cast<const char*>(bytes.data()) + kLengthBytes;
  const auto header = parse_header({text, length}, faults);
  if (!header) return result;
  if (header->members.size() > kMostTensors) {
    faults.push_back(fmt::format("header: expected at most {} tensors, got {}; {}", kMostTensors,
                                 header->members.size(), kRemedy));
    return result;
  }
  const Value* const metadata = header->find("__metadata__");
  if (metadata != nullptr) read_metadata(*metadata, result, faults);
  read_tensors(*header, bytes.subspan(kLengthBytes + length), result, faults);
  return result;
}

}  // namespace flowdlo::weights
