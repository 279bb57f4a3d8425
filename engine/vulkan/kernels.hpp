// Every kernel as a typed argument struct: fields are the shader's bindings, in its order;
// Constants its specialisation constants, in theirs. What they mean stands in the shader's head.
#pragma once

#include <array>

#include "../../shaders/push_constants.h"
#include "vulkan/binding.hpp"
#include "vulkan/plan.hpp"
#include "vulkan/shader_code.hpp"

namespace flowdlo::vulkan {

struct GemmCall {
  struct Constants {
    int lanes;
    int tile_rows;
    int tile_columns;
    int unroll;
    int activation;
    int has_residual;
    int has_pairs;
  };
  using Push = GemmPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::gemm(); }

  Texels x;
  Texels weight;
  Texels bias;
  Texels residual;
  Writes y;
  Words pairs;
  [[nodiscard]] std::array<Binding, 6> bindings() const {
    return {x, weight, bias, residual, y, pairs};
  }
};

/// As the next one, for GPUs: a row's floats lie side by side.
struct TileGemmCall {
  struct Constants {
    int threads;
    int tile_rows;
    int tile_columns;
    int slab;
    int depth;
    int half_weights;
    int activation;
    int has_residual;
  };
  using Push = TileGemmPush;
  static constexpr bool kUsesSubgroups = false;
  static ShaderCode shader() { return shaders::tile_gemm(); }

  Reads x;
  Reads weight;
  Texels bias;
  Reads residual;
  Writes y;
  [[nodiscard]] std::array<Binding, 5> bindings() const { return {x, weight, bias, residual, y}; }
};

struct MatrixGemmCall {
  struct Constants {
    int threads;
    int tile_rows;
    int tile_columns;
    int slab;
    int depth;
    int edge;
    int activation;
    int has_residual;
  };
  using Push = TileGemmPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::matrix_gemm(); }

  Reads x;
  Reads weight;
  Reads bias;
  Reads residual;
  Writes y;
  [[nodiscard]] std::array<Binding, 5> bindings() const { return {x, weight, bias, residual, y}; }
};

struct NarrowCall {
  struct Constants {
    int lanes;
    int x_texels;
    int inputs;
    int activation;
    int addends;
  };
  using Push = NarrowPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::narrow(); }

  Texels x;
  Texels weight;
  Texels bias;
  Texels first;
  Texels second;
  Writes y;
  [[nodiscard]] std::array<Binding, 6> bindings() const {
    return {x, weight, bias, first, second, y};
  }
};

struct LayerNormCall {
  struct Constants {
    int lanes;
    int across;
  };
  using Push = NoPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::layer_norm(); }

  Texels x;
  Texels gain;
  Texels shift;
  Writes y;
  [[nodiscard]] std::array<Binding, 4> bindings() const { return {x, gain, shift, y}; }
};

struct AttentionCall {
  struct Constants {
    int lanes;
    int queries;
    int block;
    int few_keys;
    int hands_round;
  };
  using Push = AttentionPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::attention(); }

  Texels query;
  Texels key_value;
  Texels valid;
  Writes result;
  Reads key_rows;
  Reads valid_rows;
  [[nodiscard]] std::array<Binding, 6> bindings() const {
    return {query, key_value, valid, result, key_rows, valid_rows};
  }
};

struct FarthestSetupCall {
  struct Constants {
    int lanes;
    int share;
  };
  using Push = FarthestPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::farthest_setup(); }

  Reads cloud;
  Texels params;
  Writes visible;
  Writes groups;
  [[nodiscard]] std::array<Binding, 4> bindings() const { return {cloud, params, visible, groups}; }
};

struct FarthestPointsCall {
  struct Constants {
    int lanes;
    int share;
    int first_pass;
    int cloud_is_texels;
  };
  using Push = FarthestPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::farthest_points(); }

  Texels cloud_texels;
  Reads cloud;
  Texels params;
  Texels previous;
  Scalars nearest_texels;
  Updates nearest;
  Writes farthest;
  Writes visible;
  [[nodiscard]] std::array<Binding, 8> bindings() const {
    return {cloud_texels, cloud, params, previous, nearest_texels, nearest, farthest, visible};
  }
};

struct FrameNormalizationCall {
  struct Constants {
    int lanes;
  };
  using Push = NoPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::frame_normalization(); }

  Texels points;
  Writes norm;
  [[nodiscard]] std::array<Binding, 2> bindings() const { return {points, norm}; }
};

struct NormalizeCall {
  struct Constants {
    int lanes;
    int inverse_form;
  };
  using Push = NoPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::normalize(); }

  Texels points;
  Texels norm;
  Writes result;
  [[nodiscard]] std::array<Binding, 3> bindings() const { return {points, norm, result}; }
};

struct MaskFeaturesCall {
  struct Constants {
    int lanes;
    int field_is_texels;
    int depth_is_texels;
    int has_depth;
  };
  using Push = MaskFeaturesPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::mask_features(); }

  Texels state;
  Texels norm;
  Texels params;
  Texels field_texels;
  Reads field;
  Scalars depth_texels;
  Reads depth;
  Writes phi;
  [[nodiscard]] std::array<Binding, 8> bindings() const {
    return {state, norm, params, field_texels, field, depth_texels, depth, phi};
  }
};

struct ConvolutionCall {
  struct Constants {
    int lanes;
    int taps_across;
    int x_is_texels;
    int hands_round;
  };
  using Push = ConvolutionPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::convolution(); }

  Texels x_texels;
  Reads x;
  Scalars map;
  Texels weight_texels;
  Reads weight;
  Texels bias;
  Writes y;
  [[nodiscard]] std::array<Binding, 7> bindings() const {
    return {x_texels, x, map, weight_texels, weight, bias, y};
  }
};

struct MaxPoolCall {
  struct Constants {
    int lanes;
    int side;
    int quads;
    int x_is_texels;
  };
  using Push = NoPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::max_pool(); }

  Texels x_texels;
  Reads x;
  Scalars map;
  Writes y;
  [[nodiscard]] std::array<Binding, 4> bindings() const { return {x_texels, x, map, y}; }
};

struct AddUpsampledCall {
  struct Constants {
    int lanes;
    int side;
    int quads;
    int they_are_texels;
  };
  using Push = NoPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::add_upsampled(); }

  Texels x_texels;
  Reads x;
  Scalars map;
  Texels y_texels;
  Updates y;
  [[nodiscard]] std::array<Binding, 5> bindings() const { return {x_texels, x, map, y_texels, y}; }
};

struct FlowStepCall {
  struct Constants {
    int lanes;
    int parameterization;
    int channels;
  };
  using Push = FlowStepPush;
  static constexpr bool kUsesSubgroups = true;
  static ShaderCode shader() { return shaders::flow_step(); }

  Texels hidden;
  Texels weight;
  Texels bias;
  Texels prior;
  Updates state;
  [[nodiscard]] std::array<Binding, 5> bindings() const {
    return {hidden, weight, bias, prior, state};
  }
};

}  // namespace flowdlo::vulkan
