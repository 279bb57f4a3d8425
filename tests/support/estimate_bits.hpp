// EstimateBits: everything an estimate says, byte for byte, but how long it took.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "flowdlo/estimator.hpp"

namespace flowdlo::testing {

class EstimateBits {
 public:
  EstimateBits(const Estimate& estimate, const Tensors& tensors) {
    add(estimate.nodes);
    add(estimate.support);
    add(estimate.sigma_m);
    for (const int value : {estimate.readings, static_cast<int>(estimate.source), estimate.draw,
                            static_cast<int>(estimate.calibrated), tensors.draws}) {
      add(value);
    }
    for (const float value :
         {estimate.confidence, estimate.mask_agreement, estimate.prior_mask_agreement}) {
      add(value);
    }
    for (const DrawReport& draw : estimate.draws) {
      add(draw.accepted);
      add(draw.finite);
      for (const float value : {draw.length_ratio, draw.max_segment_share, draw.mask_agreement}) {
        add(value);
      }
    }
    for (const Alternative& other : estimate.alternatives) {
      add(other.nodes);
      add(other.score);
      add(other.mask_agreement);
    }
    for (const auto* values : {&tensors.source, &tensors.visible, &tensors.path, &tensors.prior,
                               &tensors.draw_prior, &tensors.prediction, &tensors.mask_field}) {
      add(*values);
    }
    for (const auto* values : {&tensors.visible_valid, &tensors.support, &tensors.draw_support}) {
      add(*values);
    }
  }

  friend bool operator==(const EstimateBits&, const EstimateBits&) = default;

 private:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }

  std::string bytes_;
};

/// Throws where the frame has no estimate.
inline EstimateBits bits_of(Estimator& estimator, const Frame& frame) {
  Tensors tensors;
  const auto estimate = estimator.estimate(frame, tensors);
  if (!estimate) throw std::runtime_error(estimate.error().message);
  return {*estimate, tensors};
}

}  // namespace flowdlo::testing
