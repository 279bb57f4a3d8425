// Weights to and from .safetensors.
#include <fmt/format.h>

#include "files/whole_file.hpp"
#include "flowdlo/weights.hpp"
#include "guard/guarded.hpp"
#include "weights/calibration.hpp"
#include "weights/fdw.hpp"
#include "weights/file.hpp"
#include "weights/metadata.hpp"
#include "weights/safetensors.hpp"

namespace flowdlo {
namespace {

namespace ws = weights;

constexpr std::array kReadable{ws::DType::kF32, ws::DType::kF16, ws::DType::kBf16};

/// The file's own digest, where it names one, against that of its tensors.
void check_digest(const std::map<std::string, std::string>& fields, const std::string& got,
                  std::vector<std::string>& faults) {
  const auto expected = fields.find("sha256");
  if (expected == fields.end() || expected->second == got) return;
  faults.push_back(fmt::format(
      "tensors: expected SHA-256 {}, got {}; if they were changed on purpose, leave the metadata "
      "key sha256 out",
      ws::in_quotes(expected->second), got));
}

Result<void> exported(const std::filesystem::path& weights, const std::filesystem::path& output) {
  const auto file = ws::read_fdw(weights);
  if (!file) return file.error();
  std::vector<std::string> faults;
  std::vector<std::vector<std::uint8_t>> encoded;
  std::vector<ws::StoredTensor> stored;
  for (std::size_t i = 0; i < file->types.size(); ++i) {
    const ws::Tensor& tensor = file->weights.tensors[i];
    encoded.push_back(ws::encode(tensor, file->types[i], faults));
    const bool half = file->types[i] == ws::StorageType::kF16;
    ws::StoredTensor view;
    view.name = tensor.name;
    view.shape.assign(tensor.shape.begin(), tensor.shape.end());
    view.dtype = half ? ws::DType::kF16 : ws::DType::kF32;
    view.bytes = encoded.back();
    stored.push_back(std::move(view));
  }
  auto fields = ws::to_fields(file->weights.metadata);
  fields["sha256"] = file->sha256;
  if (file->weights.calibration) {
    ws::put_calibration(*file->weights.calibration, fields, stored, encoded, faults);
  }
  if (!faults.empty()) return ws::bad_weights(weights, faults);

  const std::string header = ws::safetensors_header(fields, stored);
  const auto* header_bytes = reinterpret_cast<const std::uint8_t*>(header.data());
  std::vector<std::span<const std::uint8_t>> parts{{header_bytes, header.size()}};
  parts.insert(parts.end(), encoded.begin(), encoded.end());
  return files::write_file(output, parts);
}

}  // namespace

Result<ws::FdwFile> ws::parse_exchanged(std::span<const std::uint8_t> bytes,
                                        const std::filesystem::path& file) {
  std::vector<std::string> faults;
  auto parsed = parse_safetensors(bytes, faults);
  if (!faults.empty()) return bad_weights(file, faults);

  FdwFile result;
  result.weights.calibration = take_calibration(parsed.metadata, parsed.tensors, faults);
  result.weights.metadata = from_fields(parsed.metadata, faults);
  for (auto& fault : weights::faults(result.weights.metadata)) faults.push_back(std::move(fault));
  const Variant variant = usable(result.weights.metadata.variant);
  const auto matched = match(parsed.tensors, manifest(variant), kReadable, faults);
  expect_finite(matched, faults);
  result.weights.tensors = decode(matched, manifest(variant));
  result.sha256 = digest(matched);
  if (faults.empty()) check_digest(parsed.metadata, result.sha256, faults);
  if (!faults.empty()) return bad_weights(file, faults);

  for (const StoredTensor* tensor : matched) {
    result.types.push_back(tensor->dtype == DType::kF16 ? StorageType::kF16 : StorageType::kF32);
  }
  return result;
}

namespace {

Result<void> imported(const std::filesystem::path& input, const std::filesystem::path& weights) {
  const auto bytes = ws::read_file(input);
  if (!bytes) return bytes.error();
  const auto file = ws::parse_exchanged(bytes->view(), input);
  if (!file) return file.error();
  return ws::write_fdw(file->weights, file->types, weights);
}

}  // namespace

Result<void> export_safetensors(const std::filesystem::path& weights,
                                const std::filesystem::path& output) {
  return guard::guarded("export_safetensors", [&] { return exported(weights, output); });
}

Result<void> import_safetensors(const std::filesystem::path& input,
                                const std::filesystem::path& weights) {
  return guard::guarded("import_safetensors", [&] { return imported(input, weights); });
}

}  // namespace flowdlo
