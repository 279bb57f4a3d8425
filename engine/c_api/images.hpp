// Images: a caller's strided images as the packed views of a Frame.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/flowdlo.h"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::c_api {

/// Where images that cannot be taken as they lie are copied to; kept from frame to frame.
struct Copies {
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color_bgr;
  std::vector<std::uint16_t> instances;
};

/// What a call does with an image.
enum class Use { kNeeded, kIfThere, kUnread };

struct Uses {
  Use depth = Use::kNeeded;
  Use mask = Use::kNeeded;
  Use color = Use::kIfThere;
  Use instances = Use::kIfThere;
};

/// What flowdlo_frame_init writes.
[[nodiscard]] flowdlo_frame default_frame();

/// Views of the region of interest of `given`, whose struct_size has been checked, into the
/// caller's memory where it is packed and of the Frame's own types, otherwise into `copies`. Fails
/// with kBadInput and every fault of sizes, strides, kinds of pixels and region; what is in the
/// images, and the intrinsics, are the estimator's affair.
[[nodiscard]] Result<Frame> frame_of(const flowdlo_frame& given, Copies& copies,
                                     const Uses& uses = {});

}  // namespace flowdlo::c_api
