#include "estimator/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "estimator/see_axes.hpp"
#include "field/axes.hpp"
#include "field/strand_field.hpp"
#include "gate/one_rope.hpp"
#include "gate/tube_score.hpp"
#include "geometry/ring.hpp"
#include "guard/guarded.hpp"
#include "path/limits.hpp"
#include "path/strand_reading.hpp"

namespace flowdlo::estimator {
namespace {

constexpr std::size_t kOfOne = 4;  // hypotheses of a further reading
constexpr double kSamePlace = 2;   // rope radii between the mean nodes of one and the same
constexpr double kOddsScore = 1;   // score that makes a hypothesis e times as likely

// Expected for each pixel before any reading was timed, in doubt too much. The field's is twice the
// 4 us of one core of a Sapphire Rapids.
constexpr double kMaskPixel_ms = 0.004;
constexpr double kFieldPixel_ms = 0.008;

using Reading = std::vector<Hypothesis>;  // what one reading brought forth, best first

/// Reading made of paths; nothing where it fails.
template <class Trace>
Reading read_by(const Trace& trace, std::size_t most, const Conditions& conditions,
                const Frame& frame, const ReadConfig& config) {
  auto reading = guard::guarded("second look", [&]() -> Result<Reading> {
    const Result<path::Traversals> paths = trace();
    if (!paths) return paths.error();
    return lift_all(*paths, conditions.cloud, conditions.visible, frame, config.prior_kind,
                    config.pool);
  });
  if (!reading) {
    throw_what_ends_a_frame(reading.error());
    return {};
  }
  if (reading->size() > most) reading->resize(most);
  return *std::move(reading);
}

/// The axes that the network sees, and the paths along them.
Result<path::Traversals> trace_seen(field::Network& network, const Frame& frame,
                                    float rope_width_px, const path::TraceConfig& config,
                                    threads::Pool* pool, std::optional<field::Axes>& axes) {
  const auto seen = field::see(frame, rope_width_px, network, false, pool);
  if (!seen) return seen.error();
  axes = field::axes(*seen);
  return path::trace_strands(frame, *axes, config);
}

bool same_place(const Hypothesis& a, const Hypothesis& b, double radius_m) {
  const bool rings = a.course.closed && b.course.closed;
  return geometry::mean_distance(a.prior.nodes, b.prior.nodes, rings) <= kSamePlace * radius_m;
}

/// The hypotheses of all readings, each place once: as the first reading has it, otherwise as the
/// one of best score.
std::vector<Hypothesis> pooled(const std::vector<Reading>& readings, double radius_m) {
  std::vector<Hypothesis> pool = readings.front();
  std::vector<Hypothesis> others;
  for (std::size_t r = 1; r < readings.size(); ++r) {
    for (const Hypothesis& hypothesis : readings[r]) {
      others.push_back(hypothesis);
      others.back().reading = static_cast<int>(r);
    }
  }
  std::stable_sort(others.begin(), others.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  for (Hypothesis& other : others) {
    const bool known = std::any_of(pool.begin(), pool.end(), [&](const Hypothesis& hypothesis) {
      return same_place(hypothesis, other, radius_m);
    });
    if (!known) pool.push_back(std::move(other));
  }
  return pool;
}

/// [0, 1] how likely the reading says that the rope runs where the hypothesis does.
double odds_of(const Hypothesis& hypothesis, const Reading& reading, double radius_m) {
  const double best = reading.front().score;
  double sum = 0;
  double here = 0;
  for (const Hypothesis& other : reading) {
    const double share = std::exp((other.score - best) / kOddsScore);
    sum += share;
    here += same_place(hypothesis, other, radius_m) ? share : 0;
  }
  return here / sum;
}

/// Lets each reading say how likely it holds each place.
void count_votes(const std::vector<Reading>& readings, double radius_m,
                 std::vector<Hypothesis>& pool) {
  const auto each = 1 / static_cast<float>(readings.size());
  for (Hypothesis& hypothesis : pool) {
    hypothesis.votes = 0;
    hypothesis.odds = 0;
    for (const Reading& reading : readings) {
      if (same_place(hypothesis, reading.front(), radius_m)) hypothesis.votes += each;
      hypothesis.odds += each * static_cast<float>(odds_of(hypothesis, reading, radius_m));
    }
  }
}

/// What readings hold together; `seen` is the one that looked most closely through the strand
/// field, null without any.
SecondLook joined(const std::vector<Reading>& readings, const Reading* seen,
                  const Conditions& conditions, const Frame& frame) {
  const auto radius_m = static_cast<double>(gate::tube_radius_m(
      readings.front().front().prior.nodes, frame.intrinsics, conditions.paths.rope_width_px));
  SecondLook look;
  look.readings = static_cast<int>(readings.size());
  look.hypotheses = pooled(readings, radius_m);
  look.axes = conditions.axes;
  look.seen = conditions.seen;
  count_votes(readings, radius_m, look.hypotheses);
  for (Hypothesis& hypothesis : look.hypotheses) {
    hypothesis.seen_odds =
        seen != nullptr ? static_cast<float>(odds_of(hypothesis, *seen, radius_m)) : 0;
  }
  return look;
}

/// Of a hypothesis that is right this holds, whatever the mask merges.
bool shaped_like_a_rope(const Hypothesis& hypothesis, const Frame& frame, float width_px) {
  const auto doubts = gate::one_rope(hypothesis.prior.nodes, frame, width_px).doubts;
  return std::find(doubts.begin(), doubts.end(), Doubt::kNoRope) == doubts.end();
}

}  // namespace

bool worth_rereading(const Conditions& conditions, const Frame& frame) {
  const path::Traversals& paths = conditions.paths;
  if (paths.filtered || paths.strands > path::kMostRereadStrands) return false;
  const auto sides = static_cast<std::size_t>(frame.width + frame.height);
  if (paths.ranked.front().points_px.size() > path::kMostRereadSides * sides) return false;
  return shaped_like_a_rope(conditions.hypotheses.front(), frame, paths.rope_width_px);
}

double magnified_px(const Frame& frame, float rope_width_px) {
  const auto masked = std::count_if(frame.mask.begin(), frame.mask.end(),
                                    [](std::uint8_t value) { return value > 127; });
  const float scale = std::min(field::kRope_px / rope_width_px, field::kMostScale);
  return static_cast<double>(masked) * static_cast<double>(scale * scale);
}

ReadingCosts::ReadingCosts() : of_mask(kMaskPixel_ms), of_field(kFieldPixel_ms) {}

SecondLook first_look(const Conditions& conditions, const Frame& frame) {
  const std::vector<Reading> readings{conditions.hypotheses};
  return joined(readings, conditions.axes ? &readings.front() : nullptr, conditions, frame);
}

Rereading::Rereading(threads::Pool& pool, bool doubtful, field::Network* field,
                     const Conditions& conditions, const Frame& frame, const ReadConfig& config,
                     const ReadingLimits& limits)
    : field_(field),
      limits_(limits),
      conditions_(conditions),
      frame_(frame),
      config_(config),
      rope_px_(doubtful && limits.budget != nullptr
                   ? magnified_px(frame, conditions.paths.rope_width_px)
                   : 0),
      reads_(planned(doubtful)),
      beside_(pool, static_cast<int>(reads_.size()),
              [this](int i) { read(reads_[static_cast<std::size_t>(i)]); }) {}

std::vector<Rereading::Read> Rereading::planned(bool doubtful) const {
  std::vector<Read> reads;
  if (!doubtful) return reads;
  if (field_ != nullptr && looks_closer() && worth_rereading(conditions_, frame_)) {
    reads.push_back({Kind::kCloserField});
  }
  const bool sees_less = frame_.color_bgr.empty() || reads.empty();
  if (!conditions_.of_mask && sees_less) reads.push_back({Kind::kMask});
  if (limits_.budget == nullptr) return reads;
  for (Read& read : reads) read.expected_ms = cost_of(read.kind).of(amount_of(read.kind));
  return reads;
}

bool Rereading::looks_closer() const {
  return !conditions_.axes || field::looks_closer(frame_, kCloser * conditions_.paths.rope_width_px,
                                                  conditions_.axes->magnified_for_px);
}

Cost& Rereading::cost_of(Kind kind) const {
  return kind == Kind::kCloserField ? limits_.costs->of_field : limits_.costs->of_mask;
}

double Rereading::amount_of(Kind kind) const {
  return kind == Kind::kCloserField ? rope_px_ / static_cast<double>(kCloser * kCloser) : rope_px_;
}

double Rereading::expected_ms() const {
  return std::accumulate(reads_.begin(), reads_.end(), 0.0,
                         [](double sum, const Read& read) { return sum + read.expected_ms; });
}

void Rereading::read(Read& result) {
  if (limits_.budget != nullptr && !limits_.budget->leaves(result.expected_ms + limits_.after_ms)) {
    result.left_out = true;
    return;
  }
  result.begin = Clock::now();
  const path::TraceConfig config = config_.trace(conditions_.cleaned);
  const auto trace = [&] {
    if (result.kind == Kind::kCloserField) {
      return trace_seen(*field_, frame_, kCloser * conditions_.paths.rope_width_px, config,
                        config_.pool, axes_);
    }
    return path::trace(frame_, config);
  };
  result.hypotheses = read_by(trace, kOfOne, conditions_, frame_, config_);
  result.end = Clock::now();
}

void Rereading::learn_costs() const {
  if (limits_.budget == nullptr) return;
  for (const Read& read : reads_) {
    if (read.left_out) {
      cost_of(read.kind).left_out();
    } else {
      cost_of(read.kind).saw(read.took_ms(), amount_of(read.kind));
    }
  }
}

SecondLook Rereading::finish() {
  beside_.finish();
  learn_costs();
  std::vector<Reading> readings{conditions_.hypotheses};
  readings.reserve(1 + reads_.size());  // one is pointed to
  const Reading* seen = conditions_.axes ? &readings.front() : nullptr;
  bool left_out = false;
  for (Read& read : reads_) {
    left_out = left_out || read.left_out;
    if (read.hypotheses.empty()) continue;
    readings.push_back(std::move(read.hypotheses));
    if (read.kind == Kind::kCloserField) seen = &readings.back();
  }
  SecondLook look = joined(readings, seen, conditions_, frame_);
  look.left_out = left_out;
  if (axes_) {
    look.seen = std::exchange(axes_->view, {});
    look.axes = std::move(axes_);
  }
  return look;
}

double Rereading::duration_ms() const {
  std::optional<Clock::time_point> begin;
  Clock::time_point end;
  for (const Read& read : reads_) {
    if (read.left_out) continue;
    begin = begin ? std::min(*begin, read.begin) : read.begin;
    end = std::max(end, read.end);
  }
  return begin ? std::chrono::duration<double, std::milli>(end - *begin).count() : 0;
}

}  // namespace flowdlo::estimator
