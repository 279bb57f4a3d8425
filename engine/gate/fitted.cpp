#include "gate/fitted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <string_view>
#include <vector>

#include "weights/calibration.hpp"

namespace flowdlo::gate {
namespace {

template <class Network>
constexpr bool fits(const weights::CalibrationNetwork& stored) {
  return Network::kInputs == static_cast<std::size_t>(stored.inputs) &&
         Network::kHidden == static_cast<std::size_t>(stored.hidden) &&
         Network::kOutputs == static_cast<std::size_t>(stored.outputs);
}
static_assert(kDrawFeatures == weights::kCalibrationDraw);
static_assert(fits<decltype(GateWeights::hypothesis)>(weights::kHypothesisNetwork));
static_assert(fits<decltype(GateWeights::closeness)>(weights::kClosenessNetwork));
static_assert(fits<decltype(GateWeights::node_error)>(weights::kNodeErrorNetwork));

/// Calls `visit` with each tensor's name and its numbers, row by row.
template <class Weights, class Visit>
void visit_rows(Weights& weights, const Visit& visit) {
  const auto network = [&](std::string_view name, auto& of) {
    const auto matrix = [&](const char* part, auto& rows) {
      for (std::size_t row = 0; row < rows.size(); ++row) {
        visit(fmt::format("{}.{}", name, part), row, std::span(rows[row]));
      }
    };
    matrix("hidden", of.hidden);
    matrix("bent", of.bent);
    matrix("straight", of.straight);
  };
  visit("draw", 0, std::span(weights.draw));
  visit("draw_margin", 0, std::span(&weights.draw_margin, 1));
  network(weights::kHypothesisNetwork.name, weights.hypothesis);
  network(weights::kClosenessNetwork.name, weights.closeness);
  network(weights::kNodeErrorNetwork.name, weights.node_error);
  visit("hypothesis_margin", 0, std::span(&weights.hypothesis_margin, 1));
  visit("sigma_share", 0, std::span(&weights.sigma_share, 1));
}

}  // namespace

GateWeights gate_weights(const weights::Calibration& calibration) {
  GateWeights weights;
  visit_rows(weights, [&](const std::string& name, std::size_t row, auto numbers) {
    const auto& values = weights::tensor_of(calibration, name).values;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<double>(values[row * numbers.size() + i]);
    }
  });
  return weights;
}

weights::Calibration calibration_of(const GateWeights& weights, const std::string& notes) {
  weights::Calibration calibration{notes, {}};
  for (auto& [name, shape] : weights::calibration_manifest()) {
    calibration.tensors.push_back({name, shape, {}});
  }
  visit_rows(weights, [&](const std::string& name, std::size_t, auto numbers) {
    const auto of =
        std::find_if(calibration.tensors.begin(), calibration.tensors.end(),
                     [&](const auto& tensor) { return tensor.name.ends_with("." + name); });
    assert(of != calibration.tensors.end());
    for (const double number : numbers) of->values.push_back(static_cast<float>(number));
  });
  return calibration;
}

std::optional<Fitted> Fitted::of_weights(const std::optional<weights::Calibration>& model,
                                         const std::optional<weights::Calibration>& field) {
  if (!model) return std::nullopt;
  Fitted fitted{gate_weights(*model)};
  if (field) fitted.to_field = gate_weights(*field);
  return fitted;
}

const GateWeights& Fitted::of(std::span<const Candidate> candidates) const {
  const bool seen = !candidates.empty() && candidates.front().axes.known;
  return seen && to_field ? *to_field : to_mask;
}

}  // namespace flowdlo::gate
