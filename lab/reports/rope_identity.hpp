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
  int jumped = 0;     ///< that lie farther than 1 cm from every rope of the frame before
  int wrong = 0;      ///< that lie farther than 1 cm from every true rope

  /// The next frame's ropes and what each is called; where the true ones run.
  void add(const std::vector<Estimate>& found, const std::vector<int>& numbers,
           const std::vector<Centerline>& truths);

  /// All counts of another scene.
  void add(const RopeIdentity& other);

 private:
  std::vector<Estimate> before_;
  std::vector<int> numbers_;
};

}  // namespace flowdlo::lab
