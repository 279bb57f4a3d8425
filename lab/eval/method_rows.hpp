// MethodRows: every method on every frame as CSV.
#pragma once

#include <span>
#include <string>

#include "eval/trial.hpp"

namespace flowdlo::eval {

/// `text` as a field of a CSV file: quoted where it has to be.
[[nodiscard]] std::string csv_field(const std::string& text);

/// A row a frame and method; errors in cm, empty without truth or without a valid output.
[[nodiscard]] std::string method_rows_csv(std::span<const Trial> trials);

}  // namespace flowdlo::eval
