// Writing a .fdw file.
#include <flatbuffers/flatbuffers.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "files/whole_file.hpp"
#include "flowdlo_weights_generated.h"
#include "weights/calibration.hpp"
#include "weights/fdw.hpp"
#include "weights/file.hpp"
#include "weights/half.hpp"
#include "weights/metadata.hpp"
#include "weights/sha256.hpp"
#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {
namespace {

static_assert(kDataAlignment <= FLATBUFFERS_MAX_ALIGNMENT);

fdw::Switch switched(bool value) { return value ? fdw::Switch::on : fdw::Switch::off; }

/// The schema's enumerations begin one higher than ours: their zero is "unset".
template <class To, class From>
To shifted(From value) {
  return static_cast<To>(static_cast<int>(value) + 1);
}

flatbuffers::Offset<fdw::Metadata> add_metadata(flatbuffers::FlatBufferBuilder& builder,
                                                const Metadata& metadata,
                                                const std::string& sha256) {
  const fdw::Mean mean(metadata.mean[0], metadata.mean[1], metadata.mean[2]);
  const Variant& variant = metadata.variant;
  return fdw::CreateMetadata(
      builder, builder.CreateString(metadata.name), builder.CreateString(metadata.version),
      builder.CreateString(metadata.training_data), builder.CreateString(metadata.licence),
      builder.CreateString(metadata.notes), &mean, metadata.scale, switched(metadata.trained),
      shifted<fdw::Parameterization>(variant.parameterization), variant.local_channels,
      switched(variant.visible_points), variant.head_channels,
      shifted<fdw::Normalization>(variant.normalization),
      shifted<fdw::PriorKind>(variant.prior_kind), variant.prior_sd, variant.local_features_version,
      builder.CreateString(sha256), metadata.fast_steps, metadata.fast_draws);
}

flatbuffers::Offset<fdw::Tensor> add_tensor(flatbuffers::FlatBufferBuilder& builder,
                                            const Tensor& tensor, StorageType type,
                                            const std::vector<std::uint8_t>& bytes) {
  const auto name = builder.CreateString(tensor.name);
  const auto shape = builder.CreateVector(tensor.shape);
  builder.ForceVectorAlignment(bytes.size(), 1, kDataAlignment);
  const auto data = builder.CreateVector(bytes);
  const auto dtype = type == StorageType::kF16 ? fdw::DType::f16 : fdw::DType::f32;
  return fdw::CreateTensor(builder, name, shape, dtype, data);
}

flatbuffers::Offset<fdw::Section> add_calibration(flatbuffers::FlatBufferBuilder& builder,
                                                  const Calibration& calibration,
                                                  const StoredCalibration& stored) {
  std::vector<flatbuffers::Offset<fdw::Tensor>> tensors;
  for (std::size_t i = 0; i < stored.bytes.size(); ++i) {
    tensors.push_back(
        add_tensor(builder, calibration.tensors[i], StorageType::kF32, stored.bytes[i]));
  }
  const auto name = builder.CreateString(kCalibrationName);
  const auto version = builder.CreateString(kCalibrationVersion);
  const auto notes = builder.CreateString(calibration.notes);
  const auto list = builder.CreateVector(tensors);
  return fdw::CreateSection(builder, name, version, notes, list,
                            builder.CreateString(stored.sha256));
}

}  // namespace

std::vector<std::uint8_t> encode(const Tensor& tensor, StorageType type,
                                 std::vector<std::string>& faults) {
  const std::size_t count = tensor.values.size();
  if (type == StorageType::kF32) {
    std::vector<std::uint8_t> bytes(count * sizeof(float));
    std::memcpy(bytes.data(), tensor.values.data(), bytes.size());
    return bytes;
  }
  std::vector<std::uint8_t> bytes(count * sizeof(std::uint16_t));
  std::size_t overflows = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t half = float_to_half(tensor.values[i]);
    overflows += (half & 0x7C00U) == 0x7C00U && std::isfinite(tensor.values[i]) ? 1 : 0;
    std::memcpy(bytes.data() + i * sizeof(half), &half, sizeof(half));
  }
  if (overflows > 0) {
    faults.push_back(fmt::format(
        "tensor {}: expected magnitudes of at most {} in f16, got {} beyond; store it as f32",
        in_quotes(tensor.name), kLargestHalf, overflows));
  }
  return bytes;
}

Result<void> write_fdw(const Weights& weights, const std::vector<StorageType>& types,
                       const std::filesystem::path& file) {
  auto list = faults(weights);
  if (!list.empty()) return bad_weights(file, list);

  std::vector<std::vector<std::uint8_t>> encoded;
  Sha256 sha;
  std::size_t total = 0;
  for (std::size_t i = 0; i < weights.tensors.size(); ++i) {
    encoded.push_back(encode(weights.tensors[i], types[i], list));
    sha.update(encoded.back());
    total += encoded.back().size();
  }
  StoredCalibration calibration;
  if (weights.calibration) calibration = encode_calibration(*weights.calibration, list);
  if (!list.empty()) return bad_weights(file, list);

  constexpr std::size_t kBesideData = std::size_t{64} << 10U;
  flatbuffers::FlatBufferBuilder builder(total + kBesideData);
  std::vector<flatbuffers::Offset<fdw::Tensor>> tensors;
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    tensors.push_back(add_tensor(builder, weights.tensors[i], types[i], encoded[i]));
  }
  const auto metadata = add_metadata(builder, weights.metadata, sha.finish());
  const auto list_of_tensors = builder.CreateVector(tensors);
  flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fdw::Section>>> sections;
  if (weights.calibration) {
    sections = builder.CreateVector(
        std::vector{add_calibration(builder, *weights.calibration, calibration)});
  }
  fdw::FinishWeightsBuffer(builder,
                           fdw::CreateWeights(builder, metadata, list_of_tensors, sections));
  return files::write_file(file, {{builder.GetBufferPointer(), builder.GetSize()}});
}

Result<void> save(const Weights& weights, const std::filesystem::path& file, StorageType type) {
  return write_fdw(weights, std::vector<StorageType>(weights.tensors.size(), type), file);
}

}  // namespace flowdlo::weights
