// BlockImage: what is done to an image in blocks besides convolutions; see ops/program.hpp.
#pragma once

namespace flowdlo::reference {

/// One block: x [side^2, channels] to y [(side / 2)^2, channels].
void max_pool(const float* x, int side, int channels, float* y);

/// One block: y [side^2, channels] += x [(side / 2)^2, channels].
void add_upsampled(const float* x, int side, int channels, float* y);

}  // namespace flowdlo::reference
