// The geometry-conditioned velocity model, Sec. 3.4, written once over ops::Program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ops/program.hpp"
#include "weights/weights.hpp"

namespace flowdlo::flow {

/// What the model is conditioned on, Eq. (3.11), as tensors of the program. M = 64 draws.
struct Conditions {
  ops::Tensor visible;               ///< [256, 4] camera frame, column 3 the validity m_obs
  ops::Tensor draw_prior;            ///< [M, 4] camera frame, column 3 the support h
  ops::Tensor params;                ///< [1, 16] ops::FrameParams
  ops::Tensor field;                 ///< [capacity, 4] evidence::MaskField
  std::optional<ops::Tensor> depth;  ///< [capacity, 1] metres; for 8 local channels
  ops::Tensor norm;                  ///< [1, 4] mean and scale of Eq. (3.10)
};

/// Records into one program. Layers and tables are uploaded on construction.
class VelocityModel {
 public:
  VelocityModel(ops::Program& program, const weights::Weights& weights, int draws, int steps);

  /// What depends on the frame alone: prior and point tokens, keys and values. Once a run.
  void record_conditions(const Conditions& conditions);

  /// One Euler step, Eq. (3.13)-(3.16), (3.27)-(3.29): state [M, 4] is updated in place.
  void record_step(const Conditions& conditions, ops::Tensor state, int k);

 private:
  struct Norm {
    ops::Tensor gain;
    ops::Tensor shift;
  };
  struct FeedForward {
    Norm norm;
    ops::LinearLayer up;
    ops::LinearLayer down;
  };
  struct CrossBlock {
    Norm norm_query;
    Norm norm_points;
    ops::LinearLayer q;
    ops::LinearLayer kv;
    ops::LinearLayer out;
    FeedForward ffn;
    ops::LinearLayer points0;
    ops::LinearLayer points2;
  };
  struct EncoderBlock {
    Norm norm;
    ops::LinearLayer qkv;
    ops::LinearLayer out;
    FeedForward ffn;
  };

  ops::LinearLayer layer(const std::string& name);
  ops::LinearLayer prior_layer();
  ops::LinearLayer scaled_local_layer();
  Norm norm(const std::string& name);
  FeedForward feed_forward(const std::string& norm_name, const std::string& up,
                           const std::string& down);
  void record_feed_forward(const FeedForward& ffn);
  void record_cross(const Conditions& conditions);
  void record_local(const Conditions& conditions, ops::Tensor state);
  void record_encoder(const EncoderBlock& block);

  ops::Program& program_;
  const weights::Weights& weights_;  // alive during construction and recording only
  int rows_;
  int steps_;

  ops::LinearLayer state_;
  ops::LinearLayer prior_;
  ops::LinearLayer local0_;
  ops::LinearLayer local2_;
  ops::LinearLayer head_;
  Norm final_norm_;
  std::optional<CrossBlock> cross_;
  std::vector<EncoderBlock> encoder_;
  ops::Tensor node_;
  ops::Tensor time_;

  ops::Tensor prior_norm_;     // [M, 4] normalised prior and support
  ops::Tensor static_tokens_;  // [M, 256] e_j + E_prior + E_h
  ops::Tensor key_value_;      // [256, 512]
  ops::Tensor tokens_;         // [M, 256] the residual stream z
  ops::Tensor normed_;         // [M, 256]
  ops::Tensor query_;          // [M, 256]
  ops::Tensor qkv_;            // [M, 768]
  ops::Tensor attended_;       // [M, 256]
  ops::Tensor hidden_;         // [M, 1024]
  ops::Tensor features_;       // [M, 8]
};

}  // namespace flowdlo::flow
