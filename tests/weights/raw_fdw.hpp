// RawFdw: a .fdw file without the writer's care, to be filled with what no writer would write.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "flowdlo_weights_generated.h"
#include "weights/half.hpp"
#include "weights/sha256.hpp"
#include "weights/weights.hpp"

namespace flowdlo::test {

struct RawTensor {
  std::string name;
  std::vector<int> shape;
  weights::fdw::DType dtype = weights::fdw::DType::f16;
  std::vector<std::uint8_t> data;
};

struct RawMetadata {
  std::string name = "raw";
  float scale = 0.15F;
  weights::fdw::Switch trained = weights::fdw::Switch::off;
  weights::fdw::Parameterization parameterization = weights::fdw::Parameterization::velocity;
  int local_channels = 6;
  weights::fdw::Switch visible_points = weights::fdw::Switch::on;
  int head_channels = 3;
  weights::fdw::Normalization normalization = weights::fdw::Normalization::global;
  weights::fdw::PriorKind prior_kind = weights::fdw::PriorKind::thesis;
  float prior_sd = 0.1F;
  int local_features_version = 1;
};

struct RawFdw {
  RawMetadata metadata;
  std::vector<RawTensor> tensors;

  /// Seeded noise of the thesis' variant, all in order.
  RawFdw() {
    namespace fdw = weights::fdw;
    for (const auto& tensor : weights::seeded({}, 5).tensors) {
      RawTensor raw{tensor.name, tensor.shape, fdw::DType::f16, {}};
      for (const float value : tensor.values) {
        const std::uint16_t half = weights::float_to_half(value);
        raw.data.push_back(static_cast<std::uint8_t>(half & 0xFFU));
        raw.data.push_back(static_cast<std::uint8_t>(half >> 8U));
      }
      tensors.push_back(std::move(raw));
    }
  }

  RawTensor& at(const std::string& name) {
    return *std::find_if(tensors.begin(), tensors.end(),
                         [&name](const RawTensor& tensor) { return tensor.name == name; });
  }

  /// The file, its digest made to fit whatever the tensors are.
  [[nodiscard]] std::string bytes(
      const char* identifier = weights::fdw::WeightsIdentifier()) const {
    namespace fdw = weights::fdw;
    weights::Sha256 sha;
    flatbuffers::FlatBufferBuilder builder;
    std::vector<flatbuffers::Offset<fdw::Tensor>> offsets;
    for (const RawTensor& tensor : tensors) {
      sha.update(tensor.data);
      offsets.push_back(fdw::CreateTensorDirect(builder, tensor.name.c_str(), &tensor.shape,
                                                tensor.dtype, &tensor.data));
    }
    const fdw::Mean mean(0.0F, 0.0F, 0.4F);
    const auto text = builder.CreateString("none");
    const auto fields = fdw::CreateMetadata(
        builder, builder.CreateString(metadata.name), text, text, text, text, &mean, metadata.scale,
        metadata.trained, metadata.parameterization, metadata.local_channels,
        metadata.visible_points, metadata.head_channels, metadata.normalization,
        metadata.prior_kind, metadata.prior_sd, metadata.local_features_version,
        builder.CreateString(sha.finish()));
    const auto list = builder.CreateVector(offsets);
    builder.Finish(fdw::CreateWeights(builder, fields, list), identifier);
    return {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()};
  }
};

}  // namespace flowdlo::test
