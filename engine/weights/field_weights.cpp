#include "weights/field_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>

#include "files/whole_file.hpp"
#include "weights/calibration.hpp"
#include "weights/fdw.hpp"
#include "weights/file.hpp"
#include "weights/safetensors.hpp"
#include "weights/seeded_noise.hpp"
#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {
namespace {

constexpr std::array kReadable{DType::kF32, DType::kF16};
constexpr int kChannelStep = 16;
// What ops::Convolution takes of blocks of 16, 8 and 4 places a side: (side + 2)^2 times as many
// inputs are 16384 at most.
constexpr int kMostFine = 48;
constexpr int kMostMiddle = 160;
constexpr int kMostCoarse = 448;

using Fields = std::map<std::string, std::string>;

std::string text_of(const Fields& fields, const std::string& key,
                    std::vector<std::string>& faults) {
  const auto found = fields.find(key);
  if (found != fields.end()) return found->second;
  faults.push_back(fmt::format("metadata {}: expected text, got none", key));
  return {};
}

int channels_of(const Fields& fields, const std::string& key, int most,
                std::vector<std::string>& faults) {
  const std::string text = text_of(fields, key, faults);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (whole && value > 0 && value <= most && value % kChannelStep == 0) return value;
  faults.push_back(fmt::format("metadata {}: expected a multiple of {} up to {}, got {}", key,
                               kChannelStep, most, in_quotes(text)));
  return kChannelStep;
}

/// Whether the file says that it holds the network of that name beside the field's.
bool holds(const Fields& fields, const std::string& key, std::string_view version,
           std::vector<std::string>& faults) {
  const auto found = fields.find(key);
  if (found == fields.end()) return false;
  if (found->second == version) return true;
  faults.push_back(
      fmt::format("metadata {}: expected \"{}\", got {}; this FlowDLO reads no other version", key,
                  version, in_quotes(found->second)));
  return false;
}

/// A network that the file may hold beside the field's.
struct Part {
  std::string name;  ///< of the section, of its version and, with "_notes", of its notes
  std::string_view version;
  std::optional<Section> FieldWeights::*section;
  std::vector<Expected> (*manifest)();
};

/// In the order in which they lie there.
const std::array<Part, 3> kParts{
    {{"refine", kRefineVersion, &FieldWeights::refine, refine_manifest},
     {"links", kLinksVersion, &FieldWeights::links, links_manifest},
     {"tips", kTipsVersion, &FieldWeights::tips, tips_manifest}}};

std::string notes_of(const Part& part) { return fmt::format("{}_notes", part.name); }

/// The field's tensors, then those of the networks that the file holds beside it.
std::vector<Expected> whole_manifest(const FieldWeights& weights) {
  auto expected = field_manifest(weights.sizes);
  const auto add = [&](std::vector<Expected> more) {
    std::move(more.begin(), more.end(), std::back_inserter(expected));
  };
  for (const Part& part : kParts) {
    if (weights.*part.section) add(part.manifest());
  }
  return expected;
}

/// The last tensors of `from`, as many as the manifest has.
std::vector<Tensor> taken_off(std::vector<Tensor>& from, const std::vector<Expected>& manifest) {
  const auto first = from.end() - static_cast<std::ptrdiff_t>(manifest.size());
  std::vector<Tensor> taken(std::make_move_iterator(first), std::make_move_iterator(from.end()));
  from.erase(first, from.end());
  return taken;
}

}  // namespace

const Tensor& FieldWeights::at(std::string_view wanted) const { return named(tensors, wanted); }

std::vector<Expected> field_manifest(const FieldSizes& sizes) {
  const auto [fine, middle, coarse] = sizes;
  std::vector<Expected> expected;
  const auto add = [&](const std::string& name, int out, int taps, int in) {
    expected.push_back({name + ".weight", {out, taps, in}});
    expected.push_back({name + ".bias", {out}});
  };
  constexpr int kSquare = 9;
  add("down_fine.0", fine, kSquare, kFieldInputs);
  add("down_fine.1", fine, kSquare, fine);
  add("down_middle.0", middle, kSquare, fine);
  add("down_middle.1", middle, kSquare, middle);
  add("coarse.0", coarse, kSquare, middle);
  add("coarse.1", coarse, kSquare, coarse);
  add("coarse.2", coarse, kSquare, coarse);
  add("to_middle", middle, 1, coarse);
  add("up_middle.0", middle, kSquare, middle);
  add("up_middle.1", middle, kSquare, middle);
  add("to_fine", fine, 1, middle);
  add("up_fine.0", fine, kSquare, fine);
  add("up_fine.1", fine, kSquare, fine);
  add("head", kFieldOutputs, 1, fine);
  return expected;
}

Result<FieldWeights> load_field(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  return parse_field(bytes->view(), file);
}

Result<FieldWeights> load_field(const Place& place) {
  return place.bytes.empty() ? load_field(place.file) : parse_field(place.bytes, place.file);
}

Result<FieldWeights> parse_field(std::span<const std::uint8_t> bytes,
                                 const std::filesystem::path& file) {
  std::vector<std::string> faults;
  auto parsed = parse_safetensors(bytes, faults);
  if (!faults.empty()) return bad_weights(file, faults);
  FieldWeights weights;
  weights.name = text_of(parsed.metadata, "name", faults);
  weights.training_data = text_of(parsed.metadata, "training_data", faults);
  weights.notes = text_of(parsed.metadata, "notes", faults);
  weights.sizes = {channels_of(parsed.metadata, "fine", kMostFine, faults),
                   channels_of(parsed.metadata, "middle", kMostMiddle, faults),
                   channels_of(parsed.metadata, "coarse", kMostCoarse, faults)};
  for (const Part& part : kParts) {
    if (!holds(parsed.metadata, part.name, part.version, faults)) continue;
    (weights.*part.section).emplace().notes = text_of(parsed.metadata, notes_of(part), faults);
  }
  weights.calibration = take_calibration(parsed.metadata, parsed.tensors, faults);
  if (!faults.empty()) return bad_weights(file, faults);
  const auto manifest = whole_manifest(weights);
  const auto matched = match(parsed.tensors, manifest, kReadable, faults);
  expect_finite(matched, faults);
  weights.tensors = decode(matched, manifest);
  for (auto part = kParts.rbegin(); part != kParts.rend(); ++part) {
    auto& section = weights.*part->section;
    if (section) section->tensors = taken_off(weights.tensors, part->manifest());
  }
  const std::string expected = text_of(parsed.metadata, "sha256", faults);
  const std::string got = digest(matched);
  if (faults.empty() && expected != got) {
    faults.push_back(fmt::format("tensors: expected SHA-256 {}, got {}; copy or export it again",
                                 in_quotes(expected), got));
  }
  if (!faults.empty()) return bad_weights(file, faults);
  return weights;
}

Result<void> save_field(const FieldWeights& weights, const std::filesystem::path& file) {
  std::vector<std::string> faults;
  std::vector<std::vector<std::uint8_t>> encoded;
  std::vector<StoredTensor> stored;
  std::vector<const Tensor*> tensors;
  for (const Tensor& tensor : weights.tensors) tensors.push_back(&tensor);
  for (const Part& part : kParts) {
    if (!(weights.*part.section)) continue;
    for (const Tensor& tensor : (weights.*part.section)->tensors) tensors.push_back(&tensor);
  }
  for (const Tensor* const of : tensors) {
    const Tensor& tensor = *of;
    auto fault = finiteness_fault(tensor.name, tensor.values);
    if (!fault.empty()) faults.push_back(std::move(fault));
    encoded.push_back(encode(tensor, StorageType::kF16, faults));
  }
  std::vector<const StoredTensor*> all;
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const Tensor& tensor = *tensors[i];
    stored.push_back(
        {tensor.name, {tensor.shape.begin(), tensor.shape.end()}, DType::kF16, "f16", encoded[i]});
  }
  for (const StoredTensor& tensor : stored) all.push_back(&tensor);
  const auto manifest = whole_manifest(weights);
  constexpr std::array kHalf{DType::kF16};
  (void)match(stored, manifest, kHalf, faults);
  if (!faults.empty()) return bad_weights(file, faults);
  Fields fields{{"name", weights.name},
                {"training_data", weights.training_data},
                {"notes", weights.notes},
                {"fine", std::to_string(weights.sizes.fine)},
                {"middle", std::to_string(weights.sizes.middle)},
                {"coarse", std::to_string(weights.sizes.coarse)},
                {"sha256", digest(all)}};
  for (const Part& part : kParts) {
    if (!(weights.*part.section)) continue;
    fields.emplace(part.name, part.version);
    fields.emplace(notes_of(part), (weights.*part.section)->notes);
  }
  if (weights.calibration) {
    put_calibration(*weights.calibration, fields, stored, encoded, faults);
    if (!faults.empty()) return bad_weights(file, faults);
  }
  const std::string header = safetensors_header(fields, stored);
  const auto* header_bytes = reinterpret_cast<const std::uint8_t*>(header.data());
  std::vector<std::span<const std::uint8_t>> parts{{header_bytes, header.size()}};
  parts.insert(parts.end(), encoded.begin(), encoded.end());
  return files::write_file(file, parts);
}

FieldWeights seeded_field(const FieldSizes& sizes, std::uint64_t seed) {
  return {"seeded noise", "none", "", sizes, seeded_noise(field_manifest(sizes), seed), {}};
}

}  // namespace flowdlo::weights
