#include "vulkan/hazards.hpp"

#include <algorithm>

namespace flowdlo::vulkan {

bool Hazards::conflict(const Range& range, bool writes) const {
  return std::any_of(touched_.begin(), touched_.end(), [&](const Touched& earlier) {
    const bool meet = earlier.range.resource == range.resource &&
                      earlier.range.offset < range.offset + range.size &&
                      range.offset < earlier.range.offset + earlier.range.size;
    return meet && (earlier.written || writes);
  });
}

}  // namespace flowdlo::vulkan
