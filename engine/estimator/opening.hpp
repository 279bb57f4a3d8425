// Opening: what an estimator is made of, from its configuration and the weights.
#pragma once

#include <optional>

#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"
#include "gate/fitted.hpp"
#include "refine/network.hpp"
#include "weights/kept_file.hpp"
#include "weights/weights.hpp"

namespace flowdlo::estimator {

/// With K and D in use, and kFull or kFast for kAuto.
[[nodiscard]] Config resolved(const Config& config, const weights::Metadata& metadata);

/// How paths become priors: as the configuration says, or the weights.
[[nodiscard]] weights::PriorKind prior_kind(const Config& config,
                                            const weights::Metadata& metadata);

[[nodiscard]] flow::SamplerConfig sampler_config(const Config& config);

/// The weights as long as `loaded` lives, then made anew from their file: for a frame larger than
/// planned and for a lost device.
[[nodiscard]] flow::WeightsSource source_of(const weights::Loaded& loaded);

/// What the strand field's file holds.
struct FieldNetworks {
  std::optional<field::Network> field{};              ///< sees strands
  std::optional<refine::Network> refine{};            ///< moves nodes; not every file has it
  std::optional<weights::Calibration> calibration{};  ///< of the gate; nor that
};

/// On the CPU, the second on one thread, for it takes a few milliseconds. None where they are off
/// or have no weights: neither the configuration's nor `beside`, those that belong to the model.
/// Fails as reading them does.
[[nodiscard]] Result<FieldNetworks> open_field(const Config& config, const weights::Place& beside);

/// The fitted score, where it decides and not the thesis' gate: unless the configuration says
/// which, `model` has to bring it, to be trained, and to be used with the refined prior, as it was
/// fitted. Fails with kBadWeights where the configuration asks for what `model` does not bring.
[[nodiscard]] Result<std::optional<gate::Fitted>> open_gate(
    const Config& config, const weights::Weights& model,
    const std::optional<weights::Calibration>& of_field);

/// To the system, what making an estimator used once: a driver's compiler and the decoded weights
/// leave 8 to 15 MB of free pieces between what stays.
void return_free_memory();

}  // namespace flowdlo::estimator
