// SeeAxes: how a reading asks for what the strand field shows.
#pragma once

#include <functional>
#include <optional>

#include "field/axes.hpp"
#include "field/network.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "threads/pool.hpp"

namespace flowdlo::estimator {

/// What a strand field shows of a frame whose rope is so many pixels wide as its mask has it;
/// nothing where the field is not to be asked, for want of time as well, or fails.
using SeeAxes = std::function<std::optional<field::Axes>(const Frame&, float rope_width_px)>;

/// Throws std::bad_alloc where `error` is want of memory, guard::Failure where a device was lost:
/// without the reading that it ended the frame's estimate would be another one.
void throw_what_ends_a_frame(const Error& error);

/// What `network`, which has to outlive it, sees; null where there is none. `near_parts` and `pool`
/// as field::see's. Its calls throw as throw_what_ends_a_frame does.
[[nodiscard]] SeeAxes seen_by(field::Network* network, bool near_parts = false,
                              threads::Pool* pool = nullptr);

}  // namespace flowdlo::estimator
