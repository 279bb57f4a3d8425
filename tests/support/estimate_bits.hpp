// EstimateBits: everything an estimate says, byte for byte, but how long it took.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "flowdlo/estimator.hpp"

namespace flowdlo::testing {

using EstimateBits = std::string;

template <class Value>
void append(EstimateBits& bits, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bits.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <class Value>
void append(EstimateBits& bits, const std::vector<Value>& values) {
  append(bits, values.size());
  for (const Value& value : values) append(bits, value);
}

inline EstimateBits bits_of(const Estimate& estimate) {
  EstimateBits bits;
  append(bits, estimate.nodes);
  append(bits, estimate.support);
  append(bits, estimate.sigma_m);
  for (const int value :
       {estimate.readings, static_cast<int>(estimate.source), estimate.draw,
        static_cast<int>(estimate.calibrated), static_cast<int>(estimate.reversed),
        static_cast<int>(estimate.switched)}) {
    append(bits, value);
  }
  const OneRope& one = estimate.one_rope;
  for (const float value :
       {estimate.confidence, estimate.mask_agreement, estimate.prior_mask_agreement, one.explained,
        one.slender, one.sides, one.even, one.left_over, one.off_mask, one.bare_gap, one.goes_on}) {
    append(bits, value);
  }
  append(bits, one.doubts);
  for (const DrawReport& draw : estimate.draws) {
    append(bits, draw.accepted);
    append(bits, draw.finite);
    for (const float value : {draw.length_ratio, draw.max_segment_share, draw.mask_agreement}) {
      append(bits, value);
    }
  }
  for (const Alternative& other : estimate.alternatives) {
    append(bits, other.nodes);
    append(bits, other.score);
    append(bits, other.mask_agreement);
  }
  return bits;
}

inline EstimateBits bits_of(const Tensors& tensors) {
  EstimateBits bits;
  append(bits, tensors.draws);
  for (const auto* values : {&tensors.source, &tensors.visible, &tensors.path, &tensors.prior,
                             &tensors.draw_prior, &tensors.prediction, &tensors.mask_field}) {
    append(bits, *values);
  }
  for (const auto* values : {&tensors.visible_valid, &tensors.support, &tensors.draw_support}) {
    append(bits, *values);
  }
  return bits;
}

/// Throws where the frame has no estimate.
inline EstimateBits bits_of(Estimator& estimator, const Frame& frame) {
  Tensors tensors;
  const auto estimate = estimator.estimate(frame, tensors);
  if (!estimate) throw std::runtime_error(estimate.error().message);
  return bits_of(*estimate) + bits_of(tensors);
}

}  // namespace flowdlo::testing
