// BentNetwork: one hidden layer beside a straight way through, of a section of a weights file.
#pragma once

#include <Eigen/Core>
#include <span>

#include "weights/section.hpp"

namespace flowdlo::weights {

/// straight x + bent tanh(hidden x). Borrows the section, whose manifest is bent_manifest().
class BentNetwork {
 public:
  explicit BentNetwork(const Section& section)
      : straight_(map(section.at("straight"))),
        bent_(map(section.at("bent"))),
        hidden_(section.at("hidden").values.data(), bent_.size(), straight_.size()) {}

  [[nodiscard]] float operator()(std::span<const float> x) const {
    const Vector in(x.data(), static_cast<Eigen::Index>(x.size()));
    const Eigen::VectorXf bends = (hidden_ * in).array().tanh();
    return straight_.dot(in) + bent_.dot(bends);
  }

 private:
  using Vector = Eigen::Map<const Eigen::VectorXf>;
  using Matrix =
      Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

  [[nodiscard]] static Vector map(const Tensor& tensor) {
    return {tensor.values.data(), static_cast<Eigen::Index>(tensor.values.size())};
  }

  Vector straight_;
  Vector bent_;
  Matrix hidden_;
};

}  // namespace flowdlo::weights
