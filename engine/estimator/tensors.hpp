// The tensors behind one estimate, gathered for the caller.
#pragma once

#include <span>
#include <vector>

#include "evidence/mask_field.hpp"
#include "field/strand_field.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/estimate.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"

namespace flowdlo::estimator {

/// `source` is [D, 64, 4] as the sampler holds it; `prior` is the best traversal's, `draw_priors`
/// what each draw was conditioned on.
[[nodiscard]] Tensors collect_tensors(std::span<const float> source, const path::Path& path,
                                      const prior::Prior& prior,
                                      std::span<const prior::Prior> draw_priors,
                                      const flow::Prediction& prediction,
                                      const evidence::MaskField& field);

/// The field as planes.
[[nodiscard]] SeenStrands seen_strands(const field::StrandField& seen);

}  // namespace flowdlo::estimator
