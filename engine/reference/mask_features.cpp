#include "reference/mask_features.hpp"

namespace flowdlo::reference {

void mask_features(std::span<const float> state, std::span<const float> norm,
                   const ops::FrameParams& params, std::span<const float> field,
                   std::span<const float> depth, std::span<float> out) {
  const auto width = static_cast<std::size_t>(params.field_width);
  const auto texel = [&](int row, int column) {
    const float* value =
        field.data() +
        (static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)) * 4;
    return std::array<float, 4>{value[0], value[1], value[2], value[3]};
  };
  mask_features_of(state, norm, params, texel, depth, out);
}

}  // namespace flowdlo::reference
