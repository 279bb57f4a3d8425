// Judge: which of all that is known about a frame the gate and the hints prefer, whether that is
// sure, and what the caller gets of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/conditions.hpp"
#include "estimator/returned.hpp"
#include "estimator/second_look.hpp"
#include "evidence/mask_field.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "gate/calibrated.hpp"
#include "gate/fitted.hpp"
#include "gate/gate.hpp"
#include "refine/network.hpp"

namespace flowdlo::estimator {

/// Confidence from which what the strand field's reading says is returned without another reading.
/// Of 500 `wide` training scenes (3000000 to 3000499) 64 % are that sure, and 0.221 cm off in the
/// mean; with all readings 0.229 (docs/accuracy.md).
inline constexpr float kSure = 0.95F;

/// What the model made of a frame; nothing where it was not asked.
struct Sampled {
  flow::Prediction prediction{};
  std::vector<int> assigned{};  ///< [D] the hypothesis that each draw was conditioned on
  gate::Verdict verdict{};      ///< of the thesis' gate
  evidence::MaskField mask_field{};
};

/// A choice among all that is known.
struct Judged {
  SecondLook look;
  Returned returned;
  Centerline nodes{};                          ///< what is returned
  std::array<std::uint8_t, kNodes> support{};  ///< [64] of these
  OneRope one_rope;                            ///< of these
  float confidence = 0;                        ///< as their doubts leave it
};

/// As the gate of one estimator has it. What it is made of has to outlive it.
class Judge {
 public:
  /// `fitted`: by the fitted score and the hints; null: as the thesis, Eq. (3.33). `refine`: the
  /// network that moves nodes; null: none does.
  Judge(const gate::Fitted* fitted, const Hints& hints, const Conditions& conditions,
        const Frame& frame, double rope_length_m, refine::Network* refine, gate::InAll in_all = {})
      : fitted_(fitted),
        hints_(hints),
        conditions_(conditions),
        frame_(frame),
        rope_length_m_(rope_length_m),
        refine_(refine),
        in_all_(std::move(in_all)) {}

  /// Of the first reading alone; nothing where it says nothing sure. A mask's is never sure: where
  /// strands are merged it has no doubt. Nor is a ring: a closer look may see two ends that touch.
  /// `traced`: its paths were known already; what told ropes apart has weighed all of them, and a
  /// rope alone is not read again. Fails as the refining network does.
  [[nodiscard]] Result<std::optional<Judged>> of_first(bool traced) const;

  /// Of all that is known. Fails likewise.
  [[nodiscard]] Result<Judged> of_all(SecondLook look, const Sampled& sampled) const;

 private:
  struct Chosen;

  [[nodiscard]] Chosen choose(SecondLook look, const Sampled& sampled) const;
  [[nodiscard]] Result<Judged> settle(Chosen chosen, const Sampled& sampled) const;

  const gate::Fitted* const fitted_;
  const Hints& hints_;
  const Conditions& conditions_;
  const Frame& frame_;
  const double rope_length_m_;
  refine::Network* const refine_;
  const gate::InAll in_all_;
};

/// The caller's view of it.
[[nodiscard]] Estimate conclude(Judged judged, std::vector<DrawReport> draws,
                                const gate::DilatedMask& mask, const Frame& frame);

/// `estimate`, whose depth is that of the ground (evidence/ground_depth): no depth supports a node.
void doubt_depth(Estimate& estimate);

}  // namespace flowdlo::estimator
