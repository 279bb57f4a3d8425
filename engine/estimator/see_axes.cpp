#include "estimator/see_axes.hpp"

#include "field/strand_field.hpp"

namespace flowdlo::estimator {

SeeAxes seen_by(field::Network* network, const Frame& frame, bool near_parts) {
  if (network == nullptr) return {};
  return [network, &frame, near_parts](float rope_width_px) -> std::optional<field::Axes> {
    const auto seen = field::see(frame, rope_width_px, *network, near_parts);
    return seen ? std::optional(field::axes(*seen)) : std::nullopt;
  };
}

}  // namespace flowdlo::estimator
