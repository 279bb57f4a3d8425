#include "estimator/several.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "estimator/parted.hpp"
#include "estimator/rope_crossings.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/stopwatch.hpp"

namespace flowdlo::estimator {
namespace {

Result<void> one_rope(const Frame& frame, const EstimateOne& one, Ropes& result) {
  auto rope = one(frame, nullptr, 1);
  if (!rope) return rope.error();
  result.ropes.push_back(*std::move(rope));
  result.instances = one_instance(frame);
  return {};
}

Result<void> several_ropes(const Frame& frame, int ropes, const EstimateOne& one, Ropes& result) {
  Stopwatch stage;
  const auto parted = part_ropes(frame, ropes);
  if (!parted) return parted.error();
  stage.lap(result.parting_ms);
  const std::size_t count = parted->paths.ropes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const RopeView view(*parted, i, frame);
    const path::Traversals traced = view.traversals();
    auto rope = one(view.frame(), &traced, 1 / static_cast<double>(count - i));
    if (!rope) {
      return Error{rope.error().code,
                   fmt::format("rope {} of {}: {}", i + 1, count, rope.error().message)};
    }
    rope->closed = parted->paths.ropes[i].closed;
    rope->confidence *= told_apart(parted->paths.lead[i]);
    result.ropes.push_back(*std::move(rope));
  }
  result.instances = sort_longest_first(parted->instances, result.ropes);
  return {};
}

}  // namespace

Result<Ropes> estimate_each(const Frame& frame, int ropes, const EstimateOne& one) {
  Stopwatch total;
  Ropes result;
  const bool alone = ropes == 1 && frame.instances.empty();
  auto done = alone ? one_rope(frame, one, result) : several_ropes(frame, ropes, one, result);
  if (!done) return done.error();
  result.crossings = rope_crossings(result.ropes, frame);
  total.lap(result.total_ms);
  return result;
}

}  // namespace flowdlo::estimator
