// Head and Euler update, Eq. (3.26)-(3.29). Twin of shaders/flow_step.
#pragma once

#include <span>

#include "ops/program.hpp"

namespace flowdlo::reference {

/// See ops::FlowStep. head_weight [channels, 256], head_bias [channels]; channels is 3 or 4.
void flow_step(const ops::FlowStep& op, std::span<const float> hidden,
               std::span<const float> head_weight, std::span<const float> head_bias,
               std::span<const float> prior, std::span<float> state);

}  // namespace flowdlo::reference
