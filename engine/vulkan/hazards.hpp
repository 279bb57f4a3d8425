// Hazards: which bytes were touched since the last barrier, so that barriers stand only where an
// operation depends on an earlier one.
#pragma once

#include <vector>

#include "vulkan/binding.hpp"

namespace flowdlo::vulkan {

class Hazards {
 public:
  /// Whether the access must wait: it meets an earlier write, or writes what was read before.
  [[nodiscard]] bool conflict(const Range& range, bool writes) const;
  void add(const Range& range, bool writes) { touched_.push_back({range, writes}); }
  /// After a barrier over everything.
  void clear() { touched_.clear(); }

 private:
  struct Touched {
    Range range;
    bool written;
  };
  std::vector<Touched> touched_;
};

}  // namespace flowdlo::vulkan
