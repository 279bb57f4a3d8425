// Opening: what an estimator is made of, from its configuration and the weights.
#pragma once

#include <memory>
#include <optional>

#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"
#include "gate/fitted.hpp"
#include "refine/network.hpp"
#include "weights/field_weights.hpp"
#include "weights/kept_file.hpp"
#include "weights/weights.hpp"

namespace flowdlo::estimator {

/// With K and D in use, and kFull or kFast for kAuto.
[[nodiscard]] Config resolved(const Config& config, const weights::Metadata& metadata);

/// How paths become priors: as the configuration says, or the weights.
[[nodiscard]] weights::PriorKind prior_kind(const Config& config,
                                            const weights::Metadata& metadata);

[[nodiscard]] flow::SamplerConfig sampler_config(const Config& config);

/// The model's weights, decoded each time: when a program is made, a frame is larger than planned,
/// or a device is lost.
[[nodiscard]] flow::WeightsSource source_of(std::shared_ptr<const weights::KeptFile> model);

/// What the strand field's file holds.
struct FieldFile {
  std::shared_ptr<const weights::FieldWeights> field{};  ///< of the network that sees strands
  std::optional<refine::Network> refine{};               ///< moves nodes; not every file has it
  std::optional<weights::Calibration> calibration{};     ///< of the gate; nor that
};

/// The network that moves nodes is made on one thread of the CPU, for it takes a few milliseconds.
/// Nothing where the field is off or has no weights: neither the configuration's nor `beside`,
/// those that belong to the model. Fails as reading them does.
[[nodiscard]] Result<FieldFile> open_field(const Config& config, const weights::Place& beside);

/// The fitted score, where it decides and not the thesis' gate: unless the configuration says
/// which, `model` has to bring it, to be trained, and to be used with the refined prior, as it was
/// fitted. Fails with kBadWeights where the configuration asks for what `model` does not bring.
[[nodiscard]] Result<std::optional<gate::Fitted>> open_gate(
    const Config& config, const weights::KeptFile& model,
    const std::optional<weights::Calibration>& of_field);

/// Whether the model's draws change nothing, so that it is asked for them with Quality::kFull
/// alone: of 2,250 estimates that the calibrated gate made of frames that a strand field had seen
/// none was a draw, nor of 206 of ropes that it had told apart (docs/accuracy.md).
[[nodiscard]] inline bool draws_idle(bool calibrated, bool sees_strands) {
  return calibrated && sees_strands;
}

/// To the system, what making an estimator used once: a driver's compiler and the decoded weights
/// leave 8 to 15 MB of free pieces between what stays.
void return_free_memory();

}  // namespace flowdlo::estimator
