// Answers: what the C++ interface returns, as structs of C.
#pragma once

#include "flowdlo/estimate.hpp"
#include "flowdlo/flowdlo.h"

namespace flowdlo::c_api {

void copy_nodes(const Centerline& nodes, float (&to)[FLOWDLO_NODES][3]);

/// With a struct_size of 0.
[[nodiscard]] flowdlo_estimate plain(const Estimate& estimate);
[[nodiscard]] flowdlo_crossing plain(const RopeCrossing& crossing);

}  // namespace flowdlo::c_api
