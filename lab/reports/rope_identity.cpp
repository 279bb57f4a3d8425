#include "reports/rope_identity.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"
#include "reports/steadiness.hpp"
#include "track/alignment.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kBegin_m = 0.01;  // node 0 of a ring may move that far beside the ring

track::Alignment align(const Estimate& now, const Estimate& before) {
  return track::align(now.nodes, now.closed && before.closed, before.nodes);
}

}  // namespace

void RopeIdentity::add(const std::vector<Estimate>& found, const std::vector<int>& numbers,
                       const std::vector<Centerline>& truths) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    ++ropes;
    wrong += std::none_of(truths.begin(), truths.end(), [&](const Centerline& truth) {
      return geometry::mean_distance(found[i].nodes, truth, found[i].closed) <= kJump_m;
    });
    std::size_t nearest = 0;
    std::optional<track::Alignment> alignment;
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const track::Alignment other = align(found[i], before_[k]);
      if (alignment && other.apart_m >= alignment->apart_m) continue;
      alignment = other;
      nearest = k;
    }
    if (!alignment) continue;
    const Estimate& same = before_[nearest];
    jumped += alignment->apart_m > kJump_m ? 1 : 0;
    mistaken += numbers_[nearest] != numbers[i] ? 1 : 0;
    if (found[i].closed && same.closed) {
      const double moved_m = geometry::distance(found[i].nodes.front(), same.nodes.front());
      begun += moved_m > alignment->apart_m + kBegin_m ? 1 : 0;
    } else {
      exchanged += alignment->reversed ? 1 : 0;
    }
  }
  before_ = found;
  numbers_ = numbers;
}

void RopeIdentity::add(const RopeIdentity& other) {
  ropes += other.ropes;
  mistaken += other.mistaken;
  exchanged += other.exchanged;
  begun += other.begun;
  jumped += other.jumped;
  wrong += other.wrong;
}

}  // namespace flowdlo::lab
