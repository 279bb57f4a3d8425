// ExampleSheet: Figure 4.3, six fixed scenes with every draw, beside TrackDLO-init.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// The scenes whose curves show most: two crossings, a C and an S, two tangles, the middle one of
/// their group each; other data sets: the middle scene of up to six groups. Chosen by name and
/// order alone, never by error.
[[nodiscard]] std::vector<const Trial*> fixed_examples(const DataSet& data_set);

/// Empty where no scene has a truth.
[[nodiscard]] Result<std::vector<std::uint8_t>> example_sheet_png(const DataSet& data_set);

}  // namespace flowdlo::eval
