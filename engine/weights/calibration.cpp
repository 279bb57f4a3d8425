#include "weights/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "weights/fdw.hpp"

namespace flowdlo::weights {
namespace {

std::string key(std::string_view of) { return fmt::format("{}{}", kCalibrationName, of); }

bool of_calibration(const StoredTensor& tensor) { return tensor.name.starts_with(key(".")); }

}  // namespace

std::vector<Expected> calibration_manifest() {
  std::vector<Expected> expected;
  const auto add = [&](const std::string& name, std::vector<int> shape) {
    expected.push_back({fmt::format("{}.{}", kCalibrationName, name), std::move(shape)});
  };
  add("draw", {kCalibrationDraw});
  add("draw_margin", {});
  for (const auto& [name, inputs, hidden, outputs] :
       {kHypothesisNetwork, kClosenessNetwork, kNodeErrorNetwork}) {
    add(fmt::format("{}.hidden", name), {hidden, inputs});
    add(fmt::format("{}.bent", name), {outputs, hidden});
    add(fmt::format("{}.straight", name), {outputs, inputs});
  }
  add("hypothesis_margin", {});
  add("sigma_share", {});
  return expected;
}

const Tensor& tensor_of(const Calibration& calibration, std::string_view wanted) {
  return named(calibration.tensors, fmt::format("{}.{}", kCalibrationName, wanted));
}

Calibration neutral_calibration() {
  constexpr float kTwoSigma = 0.95F;  // of a normal distribution's values within two deviations
  Calibration calibration{"weighs nothing", {}};
  for (auto& [name, shape] : calibration_manifest()) {
    std::size_t count = 1;
    for (const int extent : shape) count *= static_cast<std::size_t>(extent);
    const float value = name == key(".sigma_share") ? kTwoSigma : 0;
    calibration.tensors.push_back({name, shape, std::vector<float>(count, value)});
  }
  return calibration;
}

Calibration decode_calibration(const CalibrationHead& head, const std::vector<StoredTensor>& stored,
                               std::vector<std::string>& faults) {
  constexpr std::array kReadable{DType::kF32, DType::kF16};
  Calibration calibration{std::string(head.notes), {}};
  if (head.version != kCalibrationVersion) {
    faults.push_back(
        fmt::format("section {}: expected version \"{}\", got {}; this FlowDLO reads no other",
                    kCalibrationName, kCalibrationVersion, in_quotes(head.version)));
    return calibration;
  }
  const std::size_t before = faults.size();
  const auto matched = match(stored, calibration_manifest(), kReadable, faults);
  expect_finite(matched, faults);
  calibration.tensors = decode(matched, calibration_manifest());
  const std::string got = digest(matched);
  if (faults.size() == before && head.sha256 && got != *head.sha256) {
    faults.push_back(fmt::format("section {}: expected SHA-256 {}, got {}; copy or fit it again",
                                 kCalibrationName, in_quotes(*head.sha256), got));
  }
  return calibration;
}

StoredCalibration encode_calibration(const Calibration& calibration,
                                     std::vector<std::string>& faults) {
  StoredCalibration stored;
  for (const Tensor& tensor : calibration.tensors) {
    auto fault = finiteness_fault(tensor.name, tensor.values);
    if (!fault.empty()) faults.push_back(std::move(fault));
    stored.bytes.push_back(encode(tensor, StorageType::kF32, faults));
  }
  for (std::size_t i = 0; i < stored.bytes.size(); ++i) {
    const Tensor& tensor = calibration.tensors[i];
    stored.tensors.push_back({tensor.name,
                              {tensor.shape.begin(), tensor.shape.end()},
                              DType::kF32,
                              "f32",
                              stored.bytes[i]});
  }
  constexpr std::array kWritten{DType::kF32};
  stored.sha256 = digest(match(stored.tensors, calibration_manifest(), kWritten, faults));
  return stored;
}

void put_calibration(const Calibration& calibration, std::map<std::string, std::string>& metadata,
                     std::vector<StoredTensor>& stored,
                     std::vector<std::vector<std::uint8_t>>& encoded,
                     std::vector<std::string>& faults) {
  StoredCalibration section = encode_calibration(calibration, faults);
  metadata[key("")] = kCalibrationVersion;
  metadata[key("_notes")] = calibration.notes;
  metadata[key("_sha256")] = section.sha256;
  stored.insert(stored.end(), section.tensors.begin(), section.tensors.end());
  std::move(section.bytes.begin(), section.bytes.end(), std::back_inserter(encoded));
}

std::optional<Calibration> take_calibration(const std::map<std::string, std::string>& metadata,
                                            std::vector<StoredTensor>& tensors,
                                            std::vector<std::string>& faults) {
  const auto value = [&](std::string_view of) {
    const auto found = metadata.find(key(of));
    return found == metadata.end() ? std::nullopt : std::optional<std::string_view>(found->second);
  };
  const auto version = value("");
  if (!version) return std::nullopt;
  const auto first =
      std::stable_partition(tensors.begin(), tensors.end(),
                            [](const StoredTensor& tensor) { return !of_calibration(tensor); });
  const std::vector<StoredTensor> section(first, tensors.end());
  tensors.erase(first, tensors.end());
  return decode_calibration({*version, value("_notes").value_or(""), value("_sha256")}, section,
                            faults);
}

}  // namespace flowdlo::weights
