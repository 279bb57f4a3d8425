#include "reports/steadiness.hpp"

#include <algorithm>

#include "eval/metrics.hpp"

namespace flowdlo::lab {

bool Steadiness::add(const Centerline& nodes, const Centerline& truth) {
  ++frames;
  const double off = std::min(eval::index_error_m(nodes, truth),
                              eval::index_error_m(nodes, eval::reversed(truth)));
  error_m += off;
  wrong += off > kJump_m ? 1 : 0;
  bool jumped = false;
  if (before_) {
    const double same = eval::index_error_m(nodes, *before_);
    const double turned = eval::index_error_m(nodes, eval::reversed(*before_));
    exchanged += turned < same ? 1 : 0;
    jumped = std::min(same, turned) > kJump_m;
    jumps += jumped ? 1 : 0;
  }
  before_ = nodes;
  return jumped;
}

void Steadiness::add(const Steadiness& other) {
  frames += other.frames;
  exchanged += other.exchanged;
  jumps += other.jumps;
  error_m += other.error_m;
  wrong += other.wrong;
}

}  // namespace flowdlo::lab
