#include "geometry/quantile.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo::geometry {

float quantile(std::vector<float> values, float share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace flowdlo::geometry
