// Reading a .fdw file. Nothing of the buffer is followed before the verifier has passed it.
#include <flatbuffers/flatbuffers.h>
#include <fmt/format.h>

#include <algorithm>

#include "flowdlo_weights_generated.h"
#include "weights/calibration.hpp"
#include "weights/fdw.hpp"
#include "weights/file.hpp"
#include "weights/kept_file.hpp"
#include "weights/metadata.hpp"
#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {
namespace {

constexpr std::array kStorable{DType::kF32, DType::kF16};

// A valid file nests three deep and has one table for each tensor, about a hundred.
constexpr flatbuffers::uoffset_t kMostNesting = 8;
constexpr flatbuffers::uoffset_t kMostTables = 1024;
constexpr flatbuffers::uoffset_t kMostNameBytes = 256;
constexpr flatbuffers::uoffset_t kMostExtents = 16;

/// Empty when the buffer is safe to follow.
std::string envelope_fault(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kSmallest = 8;  // root offset and identifier
  if (bytes.size() < kSmallest || !fdw::WeightsBufferHasIdentifier(bytes.data())) {
    return fmt::format(
        "expected a FlatBuffer with identifier \"{}\", got {}; give a FlowDLO weights file",
        fdw::WeightsIdentifier(),
        bytes.size() < kSmallest ? fmt::format("{} bytes", bytes.size())
                                 : in_quotes({reinterpret_cast<const char*>(bytes.data()) + 4, 4}));
  }
  // The alignment of the tensors' data pads the whole file: a rest is a file cut in its padding.
  const bool whole = bytes.size() % kDataAlignment == 0;
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kMostNesting, kMostTables);
  if (whole && fdw::VerifyWeightsBuffer(verifier)) return {};
  return "expected an intact FlatBuffer, got a truncated or damaged one; copy or export it again";
}

/// 0-based from the schema's 1-based; unset or unknown becomes a value that faults() reports.
template <class To, class From>
To shifted(From value) {
  return static_cast<To>(static_cast<int>(value) - 1);
}

bool switched(const char* field, fdw::Switch value, bool fallback,
              std::vector<std::string>& faults) {
  if (value == fdw::Switch::on) return true;
  if (value == fdw::Switch::off) return false;
  faults.push_back(fmt::format("metadata {}: expected on or off, got {}; see weights/README.md",
                               field, static_cast<int>(value)));
  return fallback;
}

Metadata metadata_of(const fdw::Metadata& stored, std::vector<std::string>& faults) {
  Metadata metadata;
  metadata.name = stored.name()->str();
  metadata.version = stored.version()->str();
  metadata.training_data = stored.training_data()->str();
  metadata.licence = stored.licence()->str();
  metadata.notes = stored.notes()->str();
  metadata.mean = {stored.mean()->x(), stored.mean()->y(), stored.mean()->z()};
  metadata.scale = stored.scale();
  metadata.trained = switched("trained", stored.trained(), false, faults);
  metadata.fast_steps = stored.fast_steps();
  metadata.fast_draws = stored.fast_draws();
  Variant& variant = metadata.variant;
  variant.parameterization = shifted<ops::Parameterization>(stored.parameterization());
  variant.local_channels = stored.local_channels();
  variant.visible_points = switched("visible_points", stored.visible_points(), true, faults);
  variant.head_channels = stored.head_channels();
  variant.normalization = shifted<NormalizationKind>(stored.normalization());
  variant.prior_kind = shifted<PriorKind>(stored.prior_kind());
  variant.prior_sd = stored.prior_sd();
  variant.local_features_version = stored.local_features_version();
  for (auto& fault : weights::faults(metadata)) faults.push_back(std::move(fault));
  return metadata;
}

StoredTensor stored_tensor(const fdw::Tensor& tensor) {
  StoredTensor result;
  // A thousand tensors may share one shape or name of many megabytes: no more of either is taken
  // than tells it from the manifest's.
  result.name = {tensor.name()->c_str(), std::min(tensor.name()->size(), kMostNameBytes)};
  if (tensor.shape() != nullptr) {
    const auto extents = std::min(tensor.shape()->size(), kMostExtents);
    for (flatbuffers::uoffset_t i = 0; i < extents; ++i) {
      result.shape.push_back(tensor.shape()->Get(i));
    }
  }
  result.dtype = tensor.dtype() == fdw::DType::f32   ? DType::kF32
                 : tensor.dtype() == fdw::DType::f16 ? DType::kF16
                                                     : DType::kOther;
  result.dtype_name = result.dtype == DType::kOther
                          ? fmt::format("dtype {}", static_cast<int>(tensor.dtype()))
                          : name_of(result.dtype);
  result.bytes = {tensor.data()->data(), tensor.data()->size()};
  return result;
}

/// Of a file, or of one of its sections.
template <class Table>
std::vector<StoredTensor> stored_tensors(const Table& table) {
  std::vector<StoredTensor> stored;
  for (const fdw::Tensor* tensor : *table.tensors()) stored.push_back(stored_tensor(*tensor));
  return stored;
}

/// Unknown sections, and one that comes twice, go to `faults`.
std::optional<Calibration> calibration_in(const fdw::Weights& root,
                                          std::vector<std::string>& faults) {
  std::optional<Calibration> calibration;
  if (root.sections() == nullptr) return calibration;
  for (const fdw::Section* section : *root.sections()) {
    if (calibration || section->name()->string_view() != kCalibrationName) {
      faults.push_back(fmt::format("sections: expected at most one, \"{}\", got {}{}",
                                   kCalibrationName, in_quotes(section->name()->string_view()),
                                   calibration ? " beside it" : ""));
      break;  // a thousand of them may share one name
    }
    calibration =
        decode_calibration({section->version()->string_view(), section->notes()->string_view(),
                            section->sha256()->string_view()},
                           stored_tensors(*section), faults);
  }
  return calibration;
}

/// What a file holds, all of it checked.
struct Content {
  Metadata metadata;
  std::vector<StoredTensor> stored{};
  std::vector<const StoredTensor*> matched{};  ///< of `stored`, in the manifest's order
  std::string sha256{};                        ///< of the tensors
  std::optional<Calibration> calibration{};
};

Result<Content> checked(std::span<const std::uint8_t> bytes, const std::filesystem::path& file) {
  const std::string envelope = envelope_fault(bytes);
  if (!envelope.empty()) return bad_weights(file, {envelope});

  const fdw::Weights& root = *fdw::GetWeights(bytes.data());
  std::vector<std::string> faults;
  Content content{metadata_of(*root.metadata(), faults)};
  content.stored = stored_tensors(root);
  content.matched =
      match(content.stored, manifest(usable(content.metadata.variant)), kStorable, faults);
  expect_finite(content.matched, faults);
  content.sha256 = digest(content.matched);
  // With a tensor missing the digest must differ: that is said already.
  if (faults.empty() && content.sha256 != root.metadata()->sha256()->string_view()) {
    faults.push_back(fmt::format("tensors: expected SHA-256 {}, got {}; copy or export it again",
                                 in_quotes(root.metadata()->sha256()->string_view()),
                                 content.sha256));
  }
  content.calibration = calibration_in(root, faults);
  if (!faults.empty()) return bad_weights(file, faults);
  return content;
}

}  // namespace

Weights KeptFile::decoded() const {
  std::vector<std::string> faults;  // none: they were looked for when the file was read
  const auto stored = stored_tensors(*fdw::GetWeights(bytes_.data()));
  const auto matched = match(stored, manifest(metadata_.variant), kStorable, faults);
  return {metadata_, decode(matched, manifest(metadata_.variant)), std::nullopt};
}

Result<FdwFile> parse_fdw(std::span<const std::uint8_t> bytes, const std::filesystem::path& file) {
  auto content = checked(bytes, file);
  if (!content) return content.error();
  FdwFile result;
  result.weights = {content->metadata,
                    decode(content->matched, manifest(content->metadata.variant)),
                    std::move(content->calibration)};
  result.sha256 = std::move(content->sha256);
  for (const StoredTensor* tensor : content->matched) {
    result.types.push_back(tensor->dtype == DType::kF16 ? StorageType::kF16 : StorageType::kF32);
  }
  return result;
}

Result<FdwFile> read_fdw(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  return parse_fdw(bytes->view(), file);
}

Result<KeptFile> keep(const Place& place) {
  files::FileBytes read;
  auto bytes = place.bytes;
  if (bytes.empty()) {
    auto content = read_file(place.file);
    if (!content) return content.error();
    read = *std::move(content);
    bytes = read.view();
  }
  auto content = checked(bytes, place.file);
  if (!content) return content.error();
  return KeptFile(std::move(read), bytes, std::move(content->metadata),
                  std::move(content->calibration));
}

Result<Weights> load(const std::filesystem::path& file) {
  auto result = read_fdw(file);
  if (!result) return result.error();
  return std::move(result->weights);
}

}  // namespace flowdlo::weights
