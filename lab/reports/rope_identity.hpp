// RopeIdentity: whether what a stream of frames calls one rope stays one.
#pragma once

#include <vector>

#include "flowdlo/estimate.hpp"

namespace flowdlo::lab {

struct RopeIdentity {
  int ropes = 0;      ///< of all frames
  int mistaken = 0;   ///< under whose number the frame before has another rope than the nearest
  int exchanged = 0;  ///< whose ends changed places
  int begun = 0;      ///< rings that begin farther from where they did than they moved

  /// The next frame's ropes and what each is called.
  void add(const std::vector<Estimate>& ropes, const std::vector<int>& numbers);

  /// All counts of another scene.
  void add(const RopeIdentity& other);

 private:
  std::vector<Estimate> before_;
  std::vector<int> numbers_;
};

}  // namespace flowdlo::lab
