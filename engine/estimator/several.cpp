#include "estimator/several.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/parted.hpp"
#include "estimator/rope_confidence.hpp"
#include "estimator/rope_crossings.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/stopwatch.hpp"
#include "field/ridge.hpp"

namespace flowdlo::estimator {
namespace {

// Path::ends_met from which on what seems to be a ring has two ends that touch.
constexpr float kEndsMet = field::kTipPeak;

Result<void> one_rope(const Frame& frame, const EstimateOne& one, Ropes& result) {
  auto rope = one(frame, {}, 1);
  if (!rope) return rope.error();
  result.ropes.push_back(*std::move(rope));
  result.instances = one_instance(frame);
  return {};
}

Result<void> several_ropes(const Frame& frame, int ropes, const EstimateOne& one,
                           const SeeAxes& see, Ropes& result) {
  Stopwatch stage;
  const auto parted = part_ropes(frame, ropes, see);
  if (!parted) return parted.error();
  stage.lap(result.parting_ms);
  const std::size_t count = parted->paths.ropes.size();
  const path::Path& first = parted->paths.ropes.front();
  const bool ring = first.closed && first.ends_met < kEndsMet;
  // All readings of a rope that is alone are the whole frame's; they know rings that nothing parts.
  if (count == 1 && frame.instances.empty() && !ring) return one_rope(frame, one, result);
  std::vector<std::uint16_t> number(count + 1,
                                    0);  // of each label among those that have an estimate
  std::optional<Error> first_fault;
  for (std::size_t i = 0; i < count; ++i) {
    const RopeView view(*parted, i, frame);
    const Traced traced = view.traced();
    // A label says which pixels are a rope's: it is read in all ways, as one that is alone. That
    // it is a ring its path alone knows.
    const bool closed = parted->paths.ropes[i].closed;
    const bool labelled = !frame.instances.empty() && !closed;
    const ToldApart told{parted->witness[i], parted->paths.lead[i]};
    Part part{.traced = labelled ? nullptr : &traced};
    // Where a rope is alone there was nothing to tell apart.
    const bool one_of_several = count > 1 || closed;
    if (one_of_several) {
      part.in_all = [&](double own) { return rope_probability(told, closed, own); };
    }
    auto rope = one(view.frame(), part, 1 / static_cast<double>(count - i));
    if (!rope) {
      if (rope.error().code == ErrorCode::kOutOfMemory) return rope.error();
      if (rope.error().code == ErrorCode::kDeviceLost) return rope.error();
      if (!first_fault) {
        first_fault = Error{rope.error().code,
                            fmt::format("rope {} of {}: {}", i + 1, count, rope.error().message)};
      }
      continue;
    }
    rope->closed = closed;
    if (one_of_several) rope->confidence = rope_confidence(told, *rope);
    result.ropes.push_back(*std::move(rope));
    number[i + 1] = static_cast<std::uint16_t>(result.ropes.size());
  }
  if (result.ropes.empty() && first_fault) return *first_fault;
  std::vector<std::uint16_t> instances = parted->instances;
  for (std::uint16_t& label : instances) label = number[label];
  result.instances = sort_longest_first(std::move(instances), result.ropes);
  return {};
}

}  // namespace

Result<Ropes> estimate_each(const Frame& frame, int ropes, const EstimateOne& one,
                            const SeeAxes& see) {
  Stopwatch total;
  Ropes result;
  const bool alone = ropes == 1 && frame.instances.empty();
  auto done = alone ? one_rope(frame, one, result) : several_ropes(frame, ropes, one, see, result);
  if (!done) return done.error();
  result.crossings = rope_crossings(result.ropes, frame);
  total.lap(result.total_ms);
  return result;
}

}  // namespace flowdlo::estimator
