// Fitted: the numbers of the calibrated gate, to and from the weights file that holds them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "gate/calibrated.hpp"
#include "gate/candidate.hpp"
#include "weights/weights.hpp"

namespace flowdlo::gate {

[[nodiscard]] GateWeights gate_weights(const weights::Calibration& calibration);
[[nodiscard]] weights::Calibration calibration_of(const GateWeights& weights,
                                                  const std::string& notes);

/// What an estimator's weights bring: fitted to frames where the mask alone was read, and to those
/// that the strand field saw. A field without numbers of its own is judged by the mask's, which
/// weigh nothing that only a field can show.
struct Fitted {
  GateWeights to_mask;
  std::optional<GateWeights> to_field{};

  /// Of the model's calibration and the field's; nothing without the first.
  [[nodiscard]] static std::optional<Fitted> of_weights(
      const std::optional<weights::Calibration>& model,
      const std::optional<weights::Calibration>& field);

  /// Those that the candidates of a frame ask for.
  [[nodiscard]] const GateWeights& of(std::span<const Candidate> candidates) const;
};

}  // namespace flowdlo::gate
