// ShownFrame: all that the page shows of one frame: pictures, and a scene of curves and points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::view {

struct ShownFrame {
  std::string scene;  ///< JSON; docs/view.md has its fields
  std::string image;  ///< PNG, as big as the frame
  std::string mask;   ///< the same
  std::string field;  ///< the same; empty where there is no strand field
};

/// What an estimator said of a frame.
struct Seen {
  Ropes ropes{};      ///< one, unless several were asked for
  Tensors tensors{};  ///< of one rope; empty of several
  std::string device{};
};

/// Fails with kInternal where a picture cannot be encoded.
[[nodiscard]] Result<ShownFrame> shown_frame(const std::string& name, const Frame& frame,
                                             const Seen& seen);

/// The same of a frame without an estimate: its pictures, and `error` in the scene.
[[nodiscard]] Result<ShownFrame> shown_frame(const std::string& name, const Frame& frame,
                                             const Error& error);

/// Of a frame that could not be read: `error` in the scene, and no picture.
[[nodiscard]] ShownFrame shown_failure(const std::string& name, const Error& error);

}  // namespace flowdlo::view
