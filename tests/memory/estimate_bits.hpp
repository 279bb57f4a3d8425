// EstimateBits: all that an estimate says, as bytes; the times it took left out.
#pragma once

#include <string>

#include "flowdlo/estimate.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::testing {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline std::string bits_of(const Estimate& estimate) {
  std::string bytes;
  append(bytes, estimate.nodes);
  append(bytes, estimate.support);
  append(bytes, estimate.sigma_m);
  append(bytes, estimate.readings);
  append(bytes, estimate.source);
  append(bytes, estimate.draw);
  append(bytes, estimate.calibrated);
  append(bytes, estimate.confidence);
  append(bytes, estimate.mask_agreement);
  append(bytes, estimate.prior_mask_agreement);
  for (const DrawReport& draw : estimate.draws) append(bytes, draw.mask_agreement);
  for (const Alternative& other : estimate.alternatives) append(bytes, other.nodes);
  return bytes;
}

inline std::string bits_of(const Tensors& tensors) {
  std::string bytes;
  for (const auto* values : {&tensors.source, &tensors.visible, &tensors.path, &tensors.prior,
                             &tensors.draw_prior, &tensors.prediction, &tensors.mask_field}) {
    bytes.append(reinterpret_cast<const char*>(values->data()), values->size() * sizeof(float));
  }
  return bytes;
}

}  // namespace flowdlo::testing
