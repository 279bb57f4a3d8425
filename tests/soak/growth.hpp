// Growth: is a footprint flat over many lives of an estimator?
#pragma once

#include <string>
#include <vector>

#include "footprint.hpp"

namespace flowdlo::soak {

/// What may come on top between the second quarter of the lives and the last one. Resident memory
/// of a process that leaks nothing goes up and down by a few MB with the sizes of frames.
struct Allowance {
  double resident_mb = 0;
  double heap_mb = 0;
  double heap_mb_a_life = 0;  ///< and this for each life between the middles of both quarters
  int descriptors = 0;
  int threads = 0;
};

/// Medians over a part of the lives.
struct Level {
  double resident_mb = 0;
  double heap_mb = 0;
  double descriptors = 0;
  double threads = 0;
};

class Growth {
 public:
  void add(const Footprint& after_life) { lives_.push_back(after_life); }

  [[nodiscard]] std::size_t lives() const { return lives_.size(); }

  /// Of the second quarter of the lives: the first one warms caches up. Of nothing before 8 lives.
  [[nodiscard]] Level early() const;
  /// Of the last quarter.
  [[nodiscard]] Level late() const;

  /// A sentence a fault; empty: flat, or too few lives to tell.
  [[nodiscard]] std::vector<std::string> faults(const Allowance& allowance) const;

 private:
  [[nodiscard]] Level level(std::size_t begin, std::size_t end) const;

  std::vector<Footprint> lives_;
};

}  // namespace flowdlo::soak
