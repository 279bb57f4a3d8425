#include "estimator/second_look.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <new>

#include "estimator/confidence.hpp"
#include "gate/tube_score.hpp"
#include "geometry/polyline.hpp"
#include "guard/guarded.hpp"
#include "path/limits.hpp"
#include "path/readings.hpp"
#include "threads/team.hpp"

namespace flowdlo::estimator {
namespace {

constexpr std::size_t kOfEach = 2;  // hypotheses of a further reading
constexpr double kSamePlace = 2;    // rope radii between the mean nodes of one and the same
constexpr double kOddsScore = 1;    // score that makes a hypothesis e times as likely

/// Length of a path that is worth another reading, in sums of the image's two sides: over a hundred
/// `wide` scenes the most is 1.8. Each reading lifts paths as long as the first one's.
constexpr int kMostSides = 3;

using Reading = std::vector<Hypothesis>;  // what one reading brought forth, best first

/// What one reading makes of the frame; nothing where it fails.
Reading read_as(path::Reading kind, const Conditions& conditions, const Frame& frame,
                double rope_length_m, weights::PriorKind prior_kind) {
  auto reading = guard::guarded("second look", [&]() -> Result<Reading> {
    const auto paths = path::trace_as(kind, frame, conditions.paths.rope_width_px,
                                      {.rope_length_m = rope_length_m});
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

/// What each reading makes of the frame, those that fail left out.
std::vector<Reading> read(const std::vector<path::Reading>& kinds, const Conditions& conditions,
                          const Frame& frame, double rope_length_m, weights::PriorKind prior_kind,
                          int threads) {
  std::vector<Reading> readings(kinds.size());
  std::atomic<std::size_t> next = 0;
  const int workers = std::min(threads::count(threads), static_cast<int>(kinds.size()));
  threads::work_together(std::max(workers, 1), [&](int) {
    for (std::size_t i = next++; i < kinds.size(); i = next++) {
      readings[i] = read_as(kinds[i], conditions, frame, rope_length_m, prior_kind);
    }
  });
  std::erase_if(readings, [](const Reading& reading) { return reading.empty(); });
  return readings;
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

bool short_enough(const path::Traversals& paths, const Frame& frame) {  // a pixel a sample
  const auto most =
      static_cast<std::size_t>(kMostSides) * static_cast<std::size_t>(frame.width + frame.height);
  return paths.ranked.front().points_px.size() <= most;
}

}  // namespace

bool in_doubt(const Conditions& conditions) {
  const auto& first = conditions.hypotheses;
  const path::Traversals& paths = conditions.paths;
  if (paths.filtered || paths.strands > path::kMostRereadStrands) return false;
  return confidence(first.front().evidence, lead(first)) < kClear;
}

SecondLook look_again(const Conditions& conditions, const Frame& frame, double rope_length_m,
                      weights::PriorKind kind, int threads) {
  const auto& first = conditions.hypotheses;
  const float width_px = conditions.paths.rope_width_px;
  std::vector<path::Reading> kinds;
  if (in_doubt(conditions) && short_enough(conditions.paths, frame))
    kinds = path::further_readings(frame, width_px);
  auto readings = read(kinds, conditions, frame, rope_length_m, kind, threads);
  readings.insert(readings.begin(), first);
  const auto radius_m = static_cast<double>(
      gate::tube_radius_m(first.front().prior.nodes, frame.intrinsics, width_px));
  SecondLook look{static_cast<int>(readings.size()), pooled(readings, radius_m)};
  count_votes(readings, radius_m, look.hypotheses);
  return look;
}

}  // namespace flowdlo::estimator
