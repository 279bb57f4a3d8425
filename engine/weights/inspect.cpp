// What a weights file holds, for people.
#include <fmt/format.h>

#include <string>

#include "flowdlo/weights.hpp"
#include "guard/guarded.hpp"
#include "weights/calibration.hpp"
#include "weights/fdw.hpp"
#include "weights/location.hpp"
#include "weights/metadata.hpp"

namespace flowdlo {
namespace {

Result<weights::FdwFile> shipped() {
  const auto location = weights::default_location();
  if (!location) return location.error();
  const auto& [file, bytes] = location->model;
  return bytes.empty() ? weights::read_fdw(file) : weights::parse_fdw(bytes, file);
}

Result<WeightsInfo> inspected(const std::filesystem::path& file) {
  auto read = file.empty() ? shipped() : weights::read_fdw(file);
  if (!read) return read.error();
  WeightsInfo info;
  info.metadata = weights::to_fields(read->weights.metadata);
  info.sha256 = read->sha256;
  if (const auto& calibration = read->weights.calibration) {
    info.metadata[std::string(weights::kCalibrationName)] = weights::kCalibrationVersion;
    info.metadata[fmt::format("{}_notes", weights::kCalibrationName)] = calibration->notes;
  }
  for (std::size_t i = 0; i < read->types.size(); ++i) {
    weights::Tensor& tensor = read->weights.tensors[i];
    info.parameters += static_cast<std::int64_t>(tensor.values.size());
    const bool half = read->types[i] == weights::StorageType::kF16;
    info.tensors.push_back({std::move(tensor.name), std::move(tensor.shape), half ? "f16" : "f32"});
  }
  return info;
}

}  // namespace

Result<WeightsInfo> inspect_weights(const std::filesystem::path& file) {
  return guard::guarded("inspect_weights", [&] { return inspected(file); });
}

}  // namespace flowdlo
