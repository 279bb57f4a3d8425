// Chapter tables: Tables 4.2 and 4.4 to 4.7 from trials, beside the thesis' own figures.
#pragma once

#include <string>

#include "eval/scene_group.hpp"

namespace flowdlo::eval {

/// The scenes are our own: stands above every table with both.
inline constexpr const char* kScenesDiffer =
    "Columns in italics are the thesis' own figures, on the thesis' own 59 scenes; ours are on our "
    "scenes, which are not those: the two show how the methods rank, not who is nearer.";

/// Table 4.2 against baseline `name`, titled `title`: coverage, and errors over the scenes on which
/// all compared methods are valid. Empty where the baseline was not run.
[[nodiscard]] std::string coverage_table(const DataSet& data_set, const std::string& name,
                                         const std::string& title);

/// Table 4.4 (RQ1), with our refined prior and our estimate.
[[nodiscard]] std::string conditioning_table(const DataSet& data_set);

/// Table 4.5 (RQ2); empty where neither model was run.
[[nodiscard]] std::string sweep_table(const DataSet& data_set);

/// Table 4.6 (RQ3); empty where the model with a depth residual was not run.
[[nodiscard]] std::string residual_table(const DataSet& data_set);

/// Table 4.7 of `model`'s draws ("" is the evaluated model itself, whose estimate is shown, too).
[[nodiscard]] std::string gate_table(const DataSet& data_set, const std::string& model);

/// Scenario by scenario: our estimate and our model of the thesis' kind beside the thesis' full
/// model, and which is smaller. Empty where the groups are not the thesis'.
[[nodiscard]] std::string verdict_table(const DataSet& data_set);

}  // namespace flowdlo::eval
