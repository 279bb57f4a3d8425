// Report: what the calibrated gate makes of samples with truth, as Markdown.
#pragma once

#include <string>
#include <vector>

#include "gate/calibrated.hpp"
#include "gate_fit/sample.hpp"

namespace flowdlo::lab {

[[nodiscard]] std::string report(const std::vector<GateSample>& samples,
                                 const gate::GateWeights& weights);

}  // namespace flowdlo::lab
