/* What the C99 translation unit offers to the tests. */
#pragma once

#include "flowdlo/flowdlo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Loads the frame folder, makes an estimator on the CPU with K steps and D draws, fills `estimate`
 * and up to `capacity` alternatives, frees everything, and returns the first status that is not
 * FLOWDLO_OK. */
flowdlo_status c99_estimate(const char* folder, const char* weights, int steps, int draws,
                            flowdlo_estimate* estimate, flowdlo_alternative* alternatives,
                            int capacity);

/* An estimate of 640 x 480 px: depth in millimetres, its rows `depth_row_bytes` apart, a mask. */
flowdlo_status c99_estimate_camera(flowdlo_estimator* estimator, const uint16_t* depth,
                                   ptrdiff_t depth_row_bytes, const uint8_t* mask,
                                   flowdlo_estimate* estimate);

/* sizeof of the four structs as C sees them: config, frame, estimate, alternative. */
void c99_sizes(size_t sizes[4]);

#ifdef __cplusplus
}
#endif
