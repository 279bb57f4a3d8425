#include "estimator/see_axes.hpp"

#include <new>

#include "field/strand_field.hpp"
#include "guard/caught.hpp"

namespace flowdlo::estimator {

void throw_what_ends_a_frame(const Error& error) {
  if (error.code == ErrorCode::kOutOfMemory) throw std::bad_alloc();
  if (error.code == ErrorCode::kDeviceLost) throw guard::Failure(error);
}

SeeAxes seen_by(field::Network* network, bool near_parts, threads::Pool* pool) {
  if (network == nullptr) return {};
  return [=](const Frame& frame, float rope_width_px) -> std::optional<field::Axes> {
    const auto seen = field::see(frame, rope_width_px, *network, near_parts, pool);
    if (!seen) throw_what_ends_a_frame(seen.error());
    return seen ? std::optional(field::axes(*seen)) : std::nullopt;
  };
}

}  // namespace flowdlo::estimator
