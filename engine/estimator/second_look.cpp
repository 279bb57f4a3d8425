#include "estimator/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>

#include "estimator/confidence.hpp"
#include "field/strand_field.hpp"
#include "gate/one_rope.hpp"
#include "gate/tube_score.hpp"
#include "geometry/polyline.hpp"
#include "guard/guarded.hpp"
#include "path/limits.hpp"
#include "path/strand_reading.hpp"

namespace flowdlo::estimator {
namespace {

constexpr std::size_t kOfEach = 2;  // hypotheses of a further reading
constexpr double kSamePlace = 2;    // rope radii between the mean nodes of one and the same
constexpr double kOddsScore = 1;    // score that makes a hypothesis e times as likely

using Reading = std::vector<Hypothesis>;  // what one reading brought forth, best first

/// Reading made of paths; nothing where it fails.
template <class Trace>
Reading read_by(const Trace& trace, const Conditions& conditions, const Frame& frame,
                weights::PriorKind prior_kind) {
  auto reading = guard::guarded("second look", [&]() -> Result<Reading> {
    const Result<path::Traversals> paths = trace();
    if (!paths) return paths.error();
    return lift_all(*paths, conditions.cloud, conditions.visible, frame, prior_kind);
  });
  if (!reading) {
    // A reading that is left out for want of memory would make the frame's estimate another one.
    if (reading.error().code == ErrorCode::kOutOfMemory) throw std::bad_alloc();
    return {};
  }
  if (reading->size() > kOfEach) reading->resize(kOfEach);
  return *std::move(reading);
}

/// The paths along the axes that the network sees.
Result<path::Traversals> trace_seen(field::Network& network, const Frame& frame,
                                    float rope_width_px, const path::TraceConfig& config) {
  const auto seen = field::see(frame, rope_width_px, network);
  if (!seen) return seen.error();
  return path::trace_strands(frame, *seen, config);
}

bool same_place(const Hypothesis& a, const Hypothesis& b, double radius_m) {
  return geometry::mean_distance(a.prior.nodes, b.prior.nodes) <= kSamePlace * radius_m;
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

/// Lets each reading say how likely it holds each place.
void count_votes(const std::vector<Reading>& readings, double radius_m,
                 std::vector<Hypothesis>& pool) {
  const auto each = 1 / static_cast<float>(readings.size());
  for (Hypothesis& hypothesis : pool) {
    hypothesis.votes = 0;
    hypothesis.odds = 0;
    for (const Reading& reading : readings) {
      const double best = reading.front().score;
      double sum = 0;
      double here = 0;
      for (std::size_t i = 0; i < reading.size(); ++i) {
        const double share = std::exp((reading[i].score - best) / kOddsScore);
        const bool same = same_place(hypothesis, reading[i], radius_m);
        sum += share;
        here += same ? share : 0;
        if (i == 0 && same) hypothesis.votes += each;
      }
      hypothesis.odds += each * static_cast<float>(here / sum);
    }
  }
}

/// Of a hypothesis that is right this holds, whatever the mask merges.
bool shaped_like_a_rope(const Hypothesis& hypothesis, const Frame& frame, float width_px) {
  const auto doubts = gate::one_rope(hypothesis.prior.nodes, frame, width_px).doubts;
  return std::find(doubts.begin(), doubts.end(), Doubt::kNoRope) == doubts.end();
}

}  // namespace

std::vector<path::Reading> worth_reading(const Conditions& conditions, const Frame& frame) {
  const auto& first = conditions.hypotheses;
  const path::Traversals& paths = conditions.paths;
  if (confidence(first.front().evidence, lead(first)) >= kClear) return {};
  if (paths.filtered || paths.strands > path::kMostRereadStrands) return {};
  const auto sides = static_cast<std::size_t>(frame.width + frame.height);
  if (paths.ranked.front().points_px.size() > path::kMostRereadSides * sides) return {};
  if (!shaped_like_a_rope(first.front(), frame, paths.rope_width_px)) return {};
  return path::further_readings(frame, paths.rope_width_px);
}

Rereading::Rereading(threads::Pool& pool, std::vector<path::Reading> kinds, field::Network* field,
                     const Conditions& conditions, const Frame& frame, double rope_length_m,
                     weights::PriorKind prior_kind, std::vector<Eigen::Vector2f> ends)
    : kinds_(std::move(kinds)),
      field_(kinds_.empty() ? nullptr : field),
      conditions_(conditions),
      frame_(frame),
      rope_length_m_(rope_length_m),
      prior_kind_(prior_kind),
      ends_(std::move(ends)),
      reads_(kinds_.size() + (field_ != nullptr ? 1 : 0)),
      beside_(pool, static_cast<int>(reads_.size()),
              [this](int which) { read(static_cast<std::size_t>(which)); }) {}

void Rereading::read(std::size_t which) {
  Read& result = reads_[which];
  result.begin = Clock::now();
  const float width_px = conditions_.paths.rope_width_px;
  const path::TraceConfig config{.rope_length_m = rope_length_m_, .ends = ends_};
  const auto trace = [&] {
    if (field_ != nullptr && which == 0) return trace_seen(*field_, frame_, width_px, config);
    const std::size_t kind = which - (field_ != nullptr ? 1 : 0);
    return path::trace_as(kinds_[kind], frame_, width_px, config);
  };
  result.hypotheses = read_by(trace, conditions_, frame_, prior_kind_);
  result.end = Clock::now();
}

SecondLook Rereading::finish() {
  beside_.finish();
  std::vector<Reading> readings{conditions_.hypotheses};
  for (Read& read : reads_) {
    if (!read.hypotheses.empty()) readings.push_back(std::move(read.hypotheses));
  }
  const auto radius_m = static_cast<double>(gate::tube_radius_m(
      readings.front().front().prior.nodes, frame_.intrinsics, conditions_.paths.rope_width_px));
  SecondLook look{static_cast<int>(readings.size()), pooled(readings, radius_m)};
  count_votes(readings, radius_m, look.hypotheses);
  return look;
}

double Rereading::duration_ms() const {
  if (reads_.empty()) return 0;
  const auto first = std::min_element(
      reads_.begin(), reads_.end(), [](const Read& a, const Read& b) { return a.begin < b.begin; });
  const auto last = std::max_element(reads_.begin(), reads_.end(),
                                     [](const Read& a, const Read& b) { return a.end < b.end; });
  return std::chrono::duration<double, std::milli>(last->end - first->begin).count();
}

}  // namespace flowdlo::estimator
