// Opening: what an estimator is made of, from its configuration and the weights.
#pragma once

#include <optional>

#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"
#include "refine/network.hpp"
#include "weights/kept_file.hpp"
#include "weights/weights.hpp"

namespace flowdlo::estimator {

/// With K and D as the quality has them.
[[nodiscard]] Config resolved(const Config& config, const weights::Metadata& metadata);

/// How paths become priors: as the configuration says, or the weights.
[[nodiscard]] weights::PriorKind prior_kind(const Config& config,
                                            const weights::Metadata& metadata);

/// Whether the fitted score decides. It was fitted to the model that comes with FlowDLO.
[[nodiscard]] bool is_calibrated(const Config& config, const weights::Metadata& metadata);

[[nodiscard]] flow::SamplerConfig sampler_config(const Config& config);

/// The weights as long as `loaded` lives, then made anew from their file: for a frame larger than
/// planned and for a lost device.
[[nodiscard]] flow::WeightsSource source_of(const weights::Loaded& loaded);

/// What the strand field's file holds.
struct FieldNetworks {
  std::optional<field::Network> field{};    ///< sees strands
  std::optional<refine::Network> refine{};  ///< moves nodes; not every file has it
};

/// On the CPU, the second on one thread, for it takes a few milliseconds. None where they are off
/// or have no weights: neither the configuration's nor `beside`, those that belong to the model.
/// Fails as reading them does.
[[nodiscard]] Result<FieldNetworks> open_field(const Config& config, const weights::Place& beside);

/// To the system, what making an estimator used once: a driver's compiler and the decoded weights
/// leave 8 to 15 MB of free pieces between what stays.
void return_free_memory();

}  // namespace flowdlo::estimator
