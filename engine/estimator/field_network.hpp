// Field network: the one that Config asks for.
#pragma once

#include <filesystem>
#include <optional>

#include "field/network.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

/// The network that sees strands, on one thread of the CPU: it works beside the model. None where
/// it is off or no weights are to be had. `weights` is the model's file.
[[nodiscard]] Result<std::optional<field::Network>> open_field(
    const Config& config, const std::filesystem::path& weights);

}  // namespace flowdlo::estimator
