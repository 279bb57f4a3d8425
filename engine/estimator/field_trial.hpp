// FieldTrial: the strand field's network on a device and on the CPU, side by side: do both say the
// same, and which is faster?
#pragma once

#include "field/network.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

struct FieldTrial {
  float difference = 0;  ///< the largest, over what the CPU's values reach at most
  double device_ms = 0;  ///< of a region of 64 blocks, about a rope across 640 x 480 px
  double cpu_ms = 0;

  /// Within what kernels differ by, a hundred times over.
  [[nodiscard]] bool agrees() const { return difference < 1e-3F; }
  /// Clearly: about as fast is the device's case, which leaves the CPU to the host.
  [[nodiscard]] bool cpu_is_faster() const { return cpu_ms < 0.7 * device_ms; }
};

/// Both networks have the same weights. Fails as the device's network does, and as the CPU's.
[[nodiscard]] Result<FieldTrial> try_field(field::Network& device, field::Network& cpu);

}  // namespace flowdlo::estimator
