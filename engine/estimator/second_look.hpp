// SecondLook: where the first reading of a mask leaves doubt, what further readings make of it, and
// how many of them agree.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "estimator/conditions.hpp"
#include "field/network.hpp"
#include "flowdlo/frame.hpp"
#include "path/readings.hpp"
#include "threads/pool.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// How sure the first reading has to be of its best hypothesis to be left alone, `confidence`.
inline constexpr float kClear = 0.7F;

/// The readings of the frame that `conditions` are of which may be surer than the first one: none
/// where that one is clear, and none where another would be no better: of noise, of what has no
/// rope's shape, of a tangle beyond path::kMostRereadStrands or path::kMostRereadSides.
[[nodiscard]] std::vector<path::Reading> worth_reading(const Conditions& conditions,
                                                       const Frame& frame);

struct SecondLook {
  int readings = 1;                      ///< of the mask, the first among them
  std::vector<Hypothesis> hypotheses{};  ///< those of the first reading as they were, best first,
                                         ///< then others that run elsewhere, best first
};

/// Further readings under way on the threads of a pool. What it is made of has to outlive it.
class Rereading {
 public:
  /// `kinds` of the mask, and with a network of a strand field the one that follows its axes, where
  /// there are any other; null: none. `ends` as path::TraceConfig's.
  Rereading(threads::Pool& pool, std::vector<path::Reading> kinds, field::Network* field,
            const Conditions& conditions, const Frame& frame, double rope_length_m,
            weights::PriorKind prior_kind, std::vector<Eigen::Vector2f> ends = {});

  /// What all readings hold. Those that fail are left out; without any the hypotheses are the
  /// conditions'. Once.
  [[nodiscard]] SecondLook finish();

  /// From the first reading's begin to the last one's end, once finished; 0 without any.
  [[nodiscard]] double duration_ms() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// One reading's hypotheses, best first; none where it fails.
  struct Read {
    std::vector<Hypothesis> hypotheses;
    Clock::time_point begin;
    Clock::time_point end;
  };

  void read(std::size_t which);

  const std::vector<path::Reading> kinds_;
  field::Network* const field_;  // read first, for it takes longest
  const Conditions& conditions_;
  const Frame frame_;
  const double rope_length_m_;
  const weights::PriorKind prior_kind_;
  const std::vector<Eigen::Vector2f> ends_;
  std::vector<Read> reads_;  // one a reading
  threads::Beside beside_;   // last: it ends first
};

}  // namespace flowdlo::estimator
