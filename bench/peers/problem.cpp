#include "peers/problem.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/conditions.hpp"
#include "flow/gaussian_source.hpp"
#include "flowdlo/frame_folder.hpp"
#include "reference/mask_features.hpp"
#include "reference/normalization.hpp"

namespace flowdlo::peers {
namespace {

std::vector<float> rows_of(const evidence::VisiblePoints& visible) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < evidence::kVisiblePoints; ++i) {
    const Point3& point = visible.points_cam[i];
    rows.insert(rows.end(), {point.x, point.y, point.z, visible.valid[i] != 0 ? 1.0F : 0.0F});
  }
  return rows;
}

std::vector<float> rows_of(const prior::Prior& prior, int draws) {
  std::vector<float> rows;
  for (int draw = 0; draw < draws; ++draw) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      const Point3& point = prior.nodes[node];
      rows.insert(rows.end(), {point.x, point.y, point.z, static_cast<float>(prior.support[node])});
    }
  }
  return rows;
}

ops::FrameParams params_of(const Frame& frame, const evidence::MaskField& field) {
  ops::FrameParams params{};
  params.fx = frame.intrinsics.fx;
  params.fy = frame.intrinsics.fy;
  params.cx = frame.intrinsics.cx;
  params.cy = frame.intrinsics.cy;
  params.width = static_cast<float>(frame.width);
  params.height = static_cast<float>(frame.height);
  params.field_width = static_cast<float>(field.width);
  params.field_height = static_cast<float>(field.height);
  return params;
}

}  // namespace

std::vector<float> Problem::normalised(const std::vector<float>& rows) const {
  std::vector<float> out(rows.size());
  reference::normalize(rows, norm, out);
  return out;
}

float Problem::velocity(float t, float output, float x, float prior_x) const {
  const auto& variant = weights.metadata.variant;
  switch (variant.parameterization) {
    case ops::Parameterization::kVelocity:
      return output;
    case ops::Parameterization::kDirect:
      return (output - x) / std::max(1.0F - t, 1e-6F);
    case ops::Parameterization::kPreconditioned: {
      const float s = variant.prior_sd;
      const float den = t * t * s * s + (1 - t) * (1 - t);
      return prior_x + (t * s * s - (1 - t)) / den * (x - t * prior_x) +
             s / std::sqrt(den) * output;
    }
  }
  return output;
}

std::vector<float> Problem::without_network() const {
  const auto prior_rows = normalised(prior);
  std::vector<float> state = source;
  for (int k = 0; k < steps; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(steps);
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i] += velocity(t, 0, state[i], prior_rows[i]) / static_cast<float>(steps);
    }
  }
  return state;
}

void Problem::features(const std::vector<float>& state, std::vector<float>& out) const {
  out.resize(state.size() / 4 * 8);
  reference::mask_features(state, norm, params, field, depth, out);
}

Result<Problem> make_problem(const std::filesystem::path& weights,
                             const std::filesystem::path& frame_folder, int draws, int steps,
                             int threads) {
  auto loaded = weights::load(weights);
  if (!loaded) return loaded.error();
  const auto folder = load_frame_folder(frame_folder);
  if (!folder) return folder.error();
  const Frame frame = folder->frame();
  const auto& variant = loaded->metadata.variant;
  Timings timings;
  const auto conditions = estimator::gather(frame, {.prior_kind = variant.prior_kind}, timings);
  if (!conditions) return conditions.error();
  const auto field = evidence::mask_field(frame);

  Problem problem;
  problem.draws = draws;
  problem.steps = steps;
  problem.threads = threads;
  problem.source = flow::gaussian_source(/*seed=*/0, draws);
  problem.prior = rows_of(conditions->hypotheses.front().prior, draws);
  problem.visible = rows_of(conditions->visible);
  problem.params = params_of(frame, field);
  problem.field = field.texels;
  if (variant.local_channels == 8) problem.depth.assign(frame.depth_m.begin(), frame.depth_m.end());
  const auto& metadata = loaded->metadata;
  problem.norm = {metadata.mean[0], metadata.mean[1], metadata.mean[2], metadata.scale};
  if (variant.normalization == weights::NormalizationKind::kFrame) {
    reference::frame_normalization(problem.visible, problem.norm);
  }
  problem.weights = *std::move(loaded);
  return problem;
}

}  // namespace flowdlo::peers
