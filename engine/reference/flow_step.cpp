#include "reference/flow_step.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace flowdlo::reference {
namespace {

/// dx/dt of one row, whatever the network was trained to say.
Eigen::Vector3f velocity(const ops::FlowStep& op, const Eigen::Vector3f& output,
                         const Eigen::Vector3f& x, const Eigen::Vector3f& prior) {
  constexpr float kEpsilon = 1e-6F;  // Eq. (3.29)
  const float t = op.t;
  switch (op.parameterization) {
    case ops::Parameterization::kVelocity:
      return output;  // Eq. (3.27)
    case ops::Parameterization::kDirect:
      return (output - x) / std::max(1.0F - t, kEpsilon);  // Eq. (3.29)
    case ops::Parameterization::kPreconditioned: {
      const float s = op.prior_sd;
      const float den = t * t * s * s + (1.0F - t) * (1.0F - t);
      return prior + (t * s * s - (1.0F - t)) / den * (x - t * prior) + s / std::sqrt(den) * output;
    }
  }
  return output;
}

}  // namespace

void flow_step(const ops::FlowStep& op, std::span<const float> hidden,
               std::span<const float> head_weight, std::span<const float> head_bias,
               std::span<const float> prior, std::span<float> state) {
  using Hidden = Eigen::Map<const Eigen::Vector<float, ops::kWidth>>;
  const std::size_t channels = head_bias.size();
  for (std::size_t row = 0; row * 4 < state.size(); ++row) {
    const Hidden h(hidden.data() + row * ops::kWidth);
    Eigen::Vector4f output = Eigen::Vector4f::Zero();
    for (std::size_t channel = 0; channel < channels; ++channel) {
      output[static_cast<Eigen::Index>(channel)] =
          Hidden(head_weight.data() + channel * ops::kWidth).dot(h) + head_bias[channel];
    }
    Eigen::Map<Eigen::Vector3f> x(state.data() + row * 4);
    const Eigen::Map<const Eigen::Vector3f> p(prior.data() + row * 4);
    x += op.dt * velocity(op, output.head<3>(), x, p);  // Eq. (3.28)
    state[row * 4 + 3] = output[3];
  }
}

}  // namespace flowdlo::reference
