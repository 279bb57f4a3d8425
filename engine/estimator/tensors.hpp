// The tensors behind one estimate, gathered for the caller.
#pragma once

#include <span>

#include "estimator/conditions.hpp"
#include "estimator/judge.hpp"
#include "field/strand_field.hpp"
#include "flowdlo/estimate.hpp"

namespace flowdlo::estimator {

/// `source` is [D, 64, 4] as the sampler holds it.
[[nodiscard]] Tensors collect_tensors(std::span<const float> source, const Conditions& conditions,
                                      const Sampled& sampled);

/// The field as planes.
[[nodiscard]] SeenStrands seen_strands(const field::StrandField& seen);

}  // namespace flowdlo::estimator
