// KnownRopes: the ropes of a stream as they were last seen, and which of them a frame's ropes are.
#pragma once

#include <vector>

#include "flowdlo/estimate.hpp"
#include "flowdlo/tracker.hpp"

namespace flowdlo::track {

class KnownRopes {
 public:
  explicit KnownRopes(const TrackerConfig& config) : config_(config) {}

  /// The frame's ropes by number, each turned to how it was seen before; they are what is known
  /// from now on.
  [[nodiscard]] TrackedRopes recognise(Ropes ropes);

  /// Those of the last frame.
  [[nodiscard]] std::vector<KnownRope> last_seen() const;

  /// A frame that shows none.
  void miss_all();

  void forget() { known_.clear(); }
  void configure(const TrackerConfig& config) { config_ = config; }
  [[nodiscard]] const TrackerConfig& config() const { return config_; }

 private:
  struct Known {
    int number = 0;
    Centerline nodes{};
    bool closed = false;
    int missed = 0;  ///< frames in a row
  };

  void miss(std::vector<Known> unseen);

  TrackerConfig config_;
  std::vector<Known> known_;  ///< those of the last frame, then missing ones, the last seen first
  int next_ = 1;
};

}  // namespace flowdlo::track
