// The cheapest assignment of rows to columns.
#pragma once

#include <vector>

namespace flowdlo::track {

/// `cost` is square and finite. The column of each row, of least total cost; deterministic.
[[nodiscard]] std::vector<int> cheapest_assignment(const std::vector<std::vector<double>>& cost);

}  // namespace flowdlo::track
