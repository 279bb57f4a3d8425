// Steadiness: how often the estimates of frames that show one still scene leave each other.
#pragma once

#include <optional>

#include "flowdlo/centerline.hpp"

namespace flowdlo::lab {

inline constexpr double kJump_m = 0.01;  ///< mean index distance from one frame to the next

struct Steadiness {
  int frames = 0;      ///< with an estimate
  int exchanged = 0;   ///< the nodes fit those of the frame before better the other way round
  int jumps = 0;       ///< over kJump_m apart, whichever end comes first
  double error_m = 0;  ///< sum over the frames of the mean index error, whichever end comes first
  int wrong = 0;       ///< frames with an error over kJump_m

  /// The next frame's nodes; true where they jumped.
  bool add(const Centerline& nodes, const Centerline& truth);

  /// All counts of another scene.
  void add(const Steadiness& other);

 private:
  std::optional<Centerline> before_;
};

}  // namespace flowdlo::lab
