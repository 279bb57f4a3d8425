// Report: what the calibrated gate makes of samples with truth, as Markdown.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gate/calibrated.hpp"
#include "gate_fit/sample.hpp"

namespace flowdlo::lab {

/// The weights that decide on a frame with these candidates.
using WeightsOf = std::function<const gate::GateWeights&(std::span<const gate::Candidate>)>;

[[nodiscard]] std::string report(const std::vector<GateSample>& samples,
                                 const WeightsOf& weights_of);

}  // namespace flowdlo::lab
