#include "eval/draws.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowdlo::eval {
namespace {

std::string key(const std::string& method, const char* part) {
  return method.empty() ? part : method + "." + part;
}

std::string key(const std::string& method) { return method.empty() ? "model" : method; }

constexpr float kFarthest_m = 1000;  // beyond it nothing is worth drawing

bool finite(const Centerline& nodes) {
  const auto near = [](float value) { return std::abs(value) < kFarthest_m; };  // no NaN is
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](const Point3& p) { return near(p.x) && near(p.y) && near(p.z); });
}

std::vector<Centerline> predictions_of(const Tensors& tensors) {
  std::vector<Centerline> predictions;
  const std::span<const float> values(tensors.prediction);
  for (int d = 0; d < tensors.draws; ++d) {
    constexpr std::size_t kSize = 3 * kNodes;
    predictions.push_back(
        centerline_of(values.subspan(static_cast<std::size_t>(d) * kSize, kSize)));
  }
  return predictions;
}

}  // namespace

Centerline centerline_of(std::span<const float> values) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
  return nodes;
}

Centerline kept(const Centerline& nodes) {
  Centerline rounded{};
  const auto round = [](float value) {
    return static_cast<float>(std::round(static_cast<double>(value) / kCurveUnit_m) * kCurveUnit_m);
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    rounded[i] = {round(nodes[i].x), round(nodes[i].y), round(nodes[i].z)};
  }
  return rounded;
}

void add_draws(const Estimate& estimate, const Tensors& tensors, const std::string& method,
               Trial& trial) {
  Account& account = trial.accounts[key(method)];
  account = {};
  account.output = true;
  account.draws = static_cast<int>(estimate.draws.size());
  for (const DrawReport& draw : estimate.draws) {
    account.accepted += draw.accepted ? 1 : 0;
    account.mask_agreement += static_cast<double>(draw.mask_agreement) / account.draws;
  }
  Account& prior = trial.accounts[key(method, "prior")];
  prior = {};
  prior.output = true;
  prior.mask_agreement = static_cast<double>(estimate.prior_mask_agreement);
  if (method.find('@') != std::string::npos) return;  // nobody draws them
  auto& curves = trial.curves[key(method)];
  curves.clear();
  for (const Centerline& nodes : predictions_of(tensors)) {
    if (finite(nodes)) curves.push_back(kept(nodes));
  }
  if (method.empty()) trial.curves["prior"] = {kept(centerline_of(tensors.prior))};
}

void add_draw_scores(const Estimate& estimate, const Tensors& tensors, const Centerline& truth,
                     const std::string& method, Trial& trial) {
  const Score prior = score(centerline_of(tensors.prior), truth);
  Score best = prior;
  std::vector<Score> draws;
  std::vector<Score> hybrid;  // Eq. (3.33), draw by draw
  for (const Centerline& nodes : predictions_of(tensors)) {
    draws.push_back(score(nodes, truth));
    hybrid.push_back(estimate.draws[hybrid.size()].accepted ? draws.back() : prior);
    if (draws.back().index_m < best.index_m) best = draws.back();
  }
  trial.methods[key(method)] = mean_of(draws);
  trial.methods[key(method, "hybrid")] = mean_of(hybrid);
  trial.methods[key(method, "oracle")] = mean_of({best});
  if (!method.empty()) trial.methods[key(method, "prior")] = mean_of({prior});
}

}  // namespace flowdlo::eval
