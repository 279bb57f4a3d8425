// What tests of the C interface hand to it.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "flowdlo/flowdlo.h"
#include "flowdlo/frame.hpp"

namespace flowdlo::testing {

struct DestroyEstimator {
  void operator()(flowdlo_estimator* estimator) const { flowdlo_estimator_destroy(estimator); }
};
using Handle = std::unique_ptr<flowdlo_estimator, DestroyEstimator>;

/// Views of the images of `frame`.
inline flowdlo_frame c_frame(const Frame& frame) {
  flowdlo_frame out;
  EXPECT_EQ(flowdlo_frame_init(&out, sizeof(out)), FLOWDLO_OK);
  out.depth = {frame.depth_m.data(), 0, 0, FLOWDLO_PIXEL_F32, 0};
  out.mask = {frame.mask.data(), 0, 0, FLOWDLO_PIXEL_U8, 0};
  if (!frame.color_bgr.empty()) {
    out.color = {frame.color_bgr.data(), 0, 0, FLOWDLO_PIXEL_BGR8, 0};
  }
  out.width = frame.width;
  out.height = frame.height;
  out.fx = frame.intrinsics.fx;
  out.fy = frame.intrinsics.fy;
  out.cx = frame.intrinsics.cx;
  out.cy = frame.intrinsics.cy;
  return out;
}

inline flowdlo_estimate empty_estimate() {
  flowdlo_estimate estimate;
  EXPECT_EQ(flowdlo_estimate_init(&estimate, sizeof(estimate)), FLOWDLO_OK);
  return estimate;
}

}  // namespace flowdlo::testing
