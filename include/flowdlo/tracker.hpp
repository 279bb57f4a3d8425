// Tracker: a stream of frames in; each rope keeps its number, and its nodes their order.
#pragma once

#include <memory>
#include <vector>

#include "flowdlo/config.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

struct TrackerConfig {
  /// Metres, over 0. A rope whose nodes moved farther than that from one frame to the next, in the
  /// mean, is another rope.
  double most_moved_m = 0.1;
  /// Frames, 0 or more, that a rope may be missing from and keep its number.
  int patience = 30;
};

/// The ropes of one frame of a stream.
struct TrackedRopes {
  /// By number, not by length. Nodes run as they did in the frame before: the ends keep their
  /// order, and node 0 of a ring stays where it was.
  Ropes found;
  std::vector<int> numbers;  ///< [ropes] of each, from 1 in the order of first sight, longest first
                             ///< within a frame; none is given twice
  std::vector<int> missing;  ///< numbers of the ropes that this frame does not show and that are
                             ///< still waited for, in order
};

/// Owns an estimator and remembers the ropes of the frame before. One instance a thread, as of
/// Estimator; one instance for each camera.
class FLOWDLO_EXPORT Tracker {
 public:
  /// Fails as Estimator::create does, and with kBadInput, naming every fault of `tracking`.
  [[nodiscard]] static Result<Tracker> create(const Config& config,
                                              const TrackerConfig& tracking = {});

  /// With an estimator that is there already. Fails with kBadInput, naming every fault of
  /// `tracking`, and where `estimator` was moved from.
  [[nodiscard]] static Result<Tracker> create(Estimator estimator,
                                              const TrackerConfig& tracking = {});

  /// The one rope of the frame: Estimator::estimate, whose Hints::previous is the last estimate,
  /// unless `hints` has one. After a frame that failed, the one before it counts; after more
  /// than TrackerConfig::patience of them, none.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints = {});

  /// The same, and copies every tensor of spec section 3 to `tensors`.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints, Tensors& tensors);

  /// Estimator::estimate_ropes by heed of the frame before, told by number. Which rope is which is
  /// decided for all at once, so that they move least in total (the mean distance of the nodes,
  /// whichever end comes first). A frame in which no rope is found fails as there, and every rope
  /// is missing from it.
  [[nodiscard]] Result<TrackedRopes> estimate_ropes(const Frame& frame);

  /// Forgets every rope; numbers go on from where they were.
  void forget();

  /// From the next frame on; what is known stays. Fails as create() does of `tracking`, and then
  /// changes nothing.
  [[nodiscard]] Result<void> configure(const TrackerConfig& tracking);

  /// What it owns; null where it was moved from. Frames that are given to it are none of the
  /// stream.
  [[nodiscard]] Estimator* estimator();
  [[nodiscard]] const Estimator* estimator() const;

  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;
  ~Tracker();

 private:
  struct Impl;
  FLOWDLO_HIDDEN explicit Tracker(std::unique_ptr<Impl> impl);
  FLOWDLO_HIDDEN Result<Estimate> run(const Frame& frame, const Hints& hints, Tensors* tensors);
  [[nodiscard]] FLOWDLO_HIDDEN Result<void> usable() const;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo
