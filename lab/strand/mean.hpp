// The mean of several trained strand fields: one network between them.
#pragma once

#include <span>

#include "flowdlo/result.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

/// Every weight is the mean of that weight in `fields`. It is meant for runs that began with the
/// same weights: their mean lies in the same valley of the loss and is no worse than each
/// (Wortsman et al., Model soups, 2022). Name and training data are the last field's, the notes
/// list the notes of all; other networks and the calibration are left out. Fails with kBadInput
/// where there are none, or where one is of another size.
[[nodiscard]] Result<weights::FieldWeights> mean_of(std::span<const weights::FieldWeights> fields);

}  // namespace flowdlo::strand
