// The velocity model and its sampler a second time: double precision, plain loops, straight from
// spec section 6. What the engine's recording is checked against.
#pragma once

#include <array>
#include <vector>

#include "evidence/mask_field.hpp"
#include "flowdlo/frame.hpp"
#include "weights/weights.hpp"

namespace flowdlo::testing {

struct NaiveInput {
  Frame frame;
  evidence::MaskField field;
  std::vector<std::array<double, 4>> visible;     ///< [256] camera frame, and validity
  std::vector<std::array<double, 4>> draw_prior;  ///< [64] of one draw, camera frame, and support
  std::vector<std::array<double, 3>> source;      ///< [64] x_0
};

struct NaiveOutput {
  std::vector<std::array<double, 3>> state;  ///< [64] normalised, after K steps
  std::vector<std::array<double, 3>> nodes;  ///< [64] camera frame
  std::vector<double> log_sigma;             ///< [64]; zeros without the fourth head
};

[[nodiscard]] NaiveOutput naive_sample(const weights::Weights& weights, const NaiveInput& input,
                                       int steps);

}  // namespace flowdlo::testing
