// SecondLook: what further readings make of a frame, and how many of them agree.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/budget.hpp"
#include "estimator/conditions.hpp"
#include "field/axes.hpp"
#include "field/network.hpp"
#include "flowdlo/frame.hpp"
#include "threads/pool.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// Whether another look through the strand field may be surer than the first reading. Not where it
/// would be no better: of noise, of what has no rope's shape, of a tangle beyond
/// path::kMostRereadStrands or path::kMostRereadSides.
[[nodiscard]] bool worth_rereading(const Conditions& conditions, const Frame& frame);

/// Pixels of the mask, magnified as the network of a strand field sees a rope of that width.
[[nodiscard]] double magnified_px(const Frame& frame, float rope_width_px);

/// What a further reading takes. From frame to frame: what one frame took is what the next expects.
struct ReadingCosts {
  ReadingCosts();

  Cost of_mask;   ///< for each pixel of the rope, magnified as the network sees it
  Cost of_field;  ///< likewise
};

/// The rope's width that a doubtful frame is looked at again with, over the one that the field has
/// told. Chosen on 300 `wide` training scenes (3000000 to 3000299), where the better of both looks
/// is 0.75 cm off; at 1.4 it is 0.93.
inline constexpr float kCloser = 0.7F;

/// Until when further readings may begin.
struct ReadingLimits {
  const Budget* budget = nullptr;  ///< null: at any time
  ReadingCosts* costs = nullptr;   ///< null where `budget` is
  double after_ms = 0;             ///< what has to follow all readings
};

/// All readings of a frame.
struct SecondLook {
  int readings = 1;                        ///< of the frame, the first among them
  std::vector<Hypothesis> hypotheses{};    ///< those of the first reading as they were, best first,
                                           ///< then others that run elsewhere, best first
  std::optional<field::Axes> axes{};       ///< what the strand field shows, where it was asked
  std::optional<field::FieldView> seen{};  ///< of the field, from its closest look
  bool left_out = false;                   ///< a further reading, for want of time
};

/// The first reading alone.
[[nodiscard]] SecondLook first_look(const Conditions& conditions, const Frame& frame);

/// Further readings under way on the threads of a pool. What it is made of has to outlive it.
class Rereading {
 public:
  /// None of a frame that is not `doubtful`. Otherwise, where there is a field and it may be surer
  /// (`worth_rereading`), the one along the axes that its network sees when the rope is magnified
  /// by 1 / kCloser more, unless it cannot be. Of a frame without a picture, in which a field sees
  /// less, and where the field does not look closer, also the one of the mask alone, unless that
  /// was the first one (docs/accuracy.md).
  Rereading(threads::Pool& pool, bool doubtful, field::Network* field, const Conditions& conditions,
            const Frame& frame, const ReadConfig& config, const ReadingLimits& limits = {});

  /// What all readings will take on one thread; 0 without limits.
  [[nodiscard]] double expected_ms() const;

  /// What all readings hold. Those that fail are left out; without any the hypotheses are the
  /// conditions'. Once.
  [[nodiscard]] SecondLook finish();

  /// From the first reading's begin to the last one's end, once finished; 0 without any.
  [[nodiscard]] double duration_ms() const;

 private:
  using Clock = std::chrono::steady_clock;

  enum class Kind : std::uint8_t { kCloserField, kMask };

  /// One reading's hypotheses, best first; none where it fails.
  struct Read {
    Kind kind{};
    std::vector<Hypothesis> hypotheses{};
    Clock::time_point begin{};
    Clock::time_point end{};
    double expected_ms = 0;
    bool left_out = false;  // it would have ended too late

    [[nodiscard]] double took_ms() const {
      return std::chrono::duration<double, std::milli>(end - begin).count();
    }
  };

  [[nodiscard]] std::vector<Read> planned(bool doubtful) const;
  [[nodiscard]] bool looks_closer() const;  // than the first reading did
  [[nodiscard]] Cost& cost_of(Kind kind) const;
  [[nodiscard]] double amount_of(Kind kind) const;  // of what the cost is for each
  void read(Read& result);
  void learn_costs() const;

  field::Network* const field_;
  const ReadingLimits limits_;
  const Conditions& conditions_;
  const Frame frame_;
  const ReadConfig config_;
  double rope_px_ = 0;       // of the rope, magnified as the network sees it; 0 without limits
  std::vector<Read> reads_;  // in this order
  std::optional<field::Axes> axes_;
  threads::Beside beside_;  // last: it ends first
};

}  // namespace flowdlo::estimator
