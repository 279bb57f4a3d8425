#include "flow/time_embedding.hpp"

#include <Eigen/Core>
#include <cmath>

#include "ops/program.hpp"

namespace flowdlo::flow {
namespace {

using Token = Eigen::Vector<double, ops::kWidth>;

/// 128 sines, then 128 cosines, of 1000 t at frequencies 10000^(-i / 128). Spec section 6.
Token sinusoids(double t) {
  constexpr int kHalf = ops::kWidth / 2;
  Token token;
  for (int i = 0; i < kHalf; ++i) {
    const double angle = 1000.0 * t * std::pow(10000.0, -static_cast<double>(i) / kHalf);
    token[i] = std::sin(angle);
    token[kHalf + i] = std::cos(angle);
  }
  return token;
}

Token dense(const weights::Weights& weights, const std::string& name, const Token& x) {
  using Matrix = Eigen::Matrix<float, ops::kWidth, ops::kWidth, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> weight(weights.at(name + ".weight").values.data());
  const Eigen::Map<const Eigen::Vector<float, ops::kWidth>> bias(
      weights.at(name + ".bias").values.data());
  return weight.cast<double>() * x + bias.cast<double>();
}

}  // namespace

std::vector<float> time_tokens(const weights::Weights& weights, int steps) {
  std::vector<float> tokens;
  tokens.reserve(static_cast<std::size_t>(steps) * ops::kWidth);
  for (int k = 0; k < steps; ++k) {
    const Token before = dense(weights, "time.0", sinusoids(static_cast<double>(k) / steps));
    const Token silu = (before.array() / (1.0 + (-before.array()).exp())).matrix();
    const Token token = dense(weights, "time.2", silu);
    for (const double value : token) tokens.push_back(static_cast<float>(value));
  }
  return tokens;
}

}  // namespace flowdlo::flow
