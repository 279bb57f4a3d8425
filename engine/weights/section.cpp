#include "weights/section.hpp"

#include <fmt/format.h>

namespace flowdlo::weights {

const Tensor& Section::at(std::string_view wanted) const {
  const std::string& first = tensors.front().name;
  return named(tensors, fmt::format("{}{}", first.substr(0, first.find('.') + 1), wanted));
}

std::vector<Expected> bent_manifest(std::string_view section, int inputs, int hidden) {
  const auto key = [&](std::string_view name) { return fmt::format("{}.{}", section, name); };
  return {
      {key("hidden"), {hidden, 1, inputs}}, {key("bent"), {hidden}}, {key("straight"), {inputs}}};
}

}  // namespace flowdlo::weights
