#include "gate_fit/network_fit.hpp"

#include <Eigen/Core>
#include <cmath>
#include <numeric>
#include <random>

namespace flowdlo::lab {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMomentum = 0.9;    // of the mean slope
constexpr double kSmoothing = 0.99;  // of the mean squared slope
constexpr double kLeastSlope = 1e-8;
constexpr double kLeastDeviation = 1e-4;
constexpr double kMostDeviations = 5;  // of a feature from its mean

struct Weights {
  Matrix hidden;
  Matrix bent;
  Matrix straight;
};

/// One of the three with what its descent remembers.
struct Descent {
  Matrix mean;
  Matrix square;

  explicit Descent(const Matrix& weights)
      : mean(Matrix::Zero(weights.rows(), weights.cols())), square(mean) {}

  void step(const Matrix& slope, int number, double rate, Matrix& weights) {
    mean = kMomentum * mean + (1 - kMomentum) * slope;
    square = kSmoothing * square + (1 - kSmoothing) * slope.cwiseAbs2();
    const double centred = 1 - std::pow(kMomentum, number);
    const double scaled = 1 - std::pow(kSmoothing, number);
    weights.array() -=
        rate / centred * mean.array() / ((square / scaled).array().sqrt() + kLeastSlope);
  }
};

/// Mean and deviation of each feature; 0 and 1 of the first, which is one everywhere.
struct Standard {
  VectorXd mean;
  VectorXd deviation;
};

Standard standardise(Matrix& rows) {
  Standard standard{rows.colwise().mean(), VectorXd::Ones(rows.cols())};
  standard.mean[0] = 0;
  rows.rowwise() -= standard.mean.transpose();
  for (Index k = 1; k < rows.cols(); ++k) {
    const double deviation =
        std::sqrt(rows.col(k).squaredNorm() / static_cast<double>(rows.rows()));
    standard.deviation[k] = std::max(kLeastDeviation, deviation);
    rows.col(k) =
        (rows.col(k) / standard.deviation[k]).cwiseMin(kMostDeviations).cwiseMax(-kMostDeviations);
  }
  return standard;
}

Weights first_weights(const NetworkTask& task) {
  std::mt19937_64 engine(task.seed);
  const auto inputs = static_cast<Index>(task.inputs);
  const auto outputs = static_cast<Index>(task.outputs);
  const auto hidden = static_cast<Index>(task.hidden);
  Weights weights{Matrix(hidden, inputs), Matrix::Zero(outputs, hidden),
                  Matrix::Zero(outputs, inputs)};
  // From zero, hidden weights and what is made of them never move.
  const double reach = task.bends ? 1 / std::sqrt(static_cast<double>(inputs)) : 0;
  for (Index i = 0; i < weights.hidden.size(); ++i) {
    const double uniform = static_cast<double>(engine() >> 11) / 9007199254740992;
    weights.hidden.data()[i] = reach * (2 * uniform - 1);
  }
  for (Index k = 0; k < outputs; ++k) {
    weights.straight(k, 0) = task.start[static_cast<std::size_t>(k)];
  }
  return weights;
}

/// Mean slope of the rows that this step takes.
Weights slope_of(const NetworkTask& task, const Matrix& rows, const Weights& weights, int step) {
  const auto stride = static_cast<Index>(task.stride);
  const std::size_t batch =
      task.batches.empty() ? 0 : static_cast<std::size_t>(step - 1) % task.batches.size();
  Index first = (step - 1) % stride;
  Index count = (rows.rows() - first + stride - 1) / stride;
  if (!task.batches.empty()) {
    first = static_cast<Index>(
        std::accumulate(task.batches.begin(),
                        task.batches.begin() + static_cast<std::ptrdiff_t>(batch), std::size_t{0}));
    count = static_cast<Index>(task.batches[batch]);
  }
  const Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> taken(
      rows.data() + first * rows.cols(), count, rows.cols(),
      Eigen::OuterStride<>(stride * rows.cols()));
  const Matrix bends = (taken * weights.hidden.transpose()).array().tanh();
  const Matrix said = taken * weights.straight.transpose() + bends * weights.bent.transpose();
  Matrix slope = Matrix::Zero(count, said.cols());
  const auto size = static_cast<std::size_t>(slope.size());
  if (task.slopes) task.slopes(batch, {said.data(), size}, {slope.data(), size});
  for (Index i = 0; !task.slopes && i < count; ++i) {
    const auto row = static_cast<std::size_t>(first + i * stride);
    task.slope(row, {said.row(i).data(), task.outputs}, {slope.row(i).data(), task.outputs});
  }
  slope /= static_cast<double>(count);
  const Matrix bend_slope =
      ((slope * weights.bent).array() * (1 - bends.array().square())).matrix();
  Weights result{bend_slope.transpose() * taken, slope.transpose() * bends,
                 slope.transpose() * taken};
  result.hidden += task.ridge * weights.hidden;
  result.bent += task.ridge * weights.bent;
  result.straight += task.ridge * weights.straight;
  result.straight.col(0) -= task.ridge * weights.straight.col(0);
  return result;
}

/// Weights of the features as they come, of those of standardised ones.
void unstandardise(const Standard& standard, Matrix& weights) {
  for (Index k = 1; k < weights.cols(); ++k) {
    weights.col(k) /= standard.deviation[k];
    weights.col(0) -= weights.col(k) * standard.mean[k];
  }
}

std::vector<double> values(const Matrix& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

}  // namespace

NetworkWeights fit_network(const NetworkTask& task) {
  const auto inputs = static_cast<Index>(task.inputs);
  Matrix rows = Eigen::Map<const Matrix>(task.rows.data(),
                                         static_cast<Index>(task.rows.size()) / inputs, inputs);
  const Standard standard = standardise(rows);
  Weights weights = first_weights(task);
  Descent hidden(weights.hidden);
  Descent bent(weights.bent);
  Descent straight(weights.straight);
  for (int step = 1; step <= task.steps; ++step) {
    const Weights slope = slope_of(task, rows, weights, step);
    const double rate = task.rate * (1 - static_cast<double>(step - 1) / task.steps);
    hidden.step(slope.hidden, step, rate, weights.hidden);
    bent.step(slope.bent, step, rate, weights.bent);
    straight.step(slope.straight, step, rate, weights.straight);
  }
  unstandardise(standard, weights.hidden);
  unstandardise(standard, weights.straight);
  return {values(weights.hidden), values(weights.bent), values(weights.straight)};
}

NetworkWeights fit_mean_of_networks(NetworkTask task, int count) {
  NetworkWeights all;
  std::vector<NetworkWeights> each;
  for (int i = 0; i < count; ++i, ++task.seed) each.push_back(fit_network(task));
  all.straight.assign(each.front().straight.size(), 0);
  for (const NetworkWeights& one : each) {
    all.hidden.insert(all.hidden.end(), one.hidden.begin(), one.hidden.end());
    for (std::size_t k = 0; k < all.straight.size(); ++k)
      all.straight[k] += one.straight[k] / count;
  }
  for (std::size_t output = 0; output < task.outputs; ++output) {
    for (const NetworkWeights& one : each) {
      for (std::size_t h = 0; h < task.hidden; ++h) {
        all.bent.push_back(one.bent[output * task.hidden + h] / count);
      }
    }
  }
  return all;
}

weights::Section section_of(const NetworkWeights& fitted,
                            const std::vector<weights::Expected>& manifest) {
  weights::Section section;
  for (const auto& [name, shape] : manifest) {
    const auto& from = name.ends_with("hidden") ? fitted.hidden
                       : name.ends_with("bent") ? fitted.bent
                                                : fitted.straight;
    section.tensors.push_back({name, shape, {from.begin(), from.end()}});
  }
  return section;
}

}  // namespace flowdlo::lab
