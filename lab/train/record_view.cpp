#include "train/record_view.hpp"

#include <algorithm>
#include <cmath>

#include "prior/prior.hpp"
#include "reference/mask_features.hpp"
#include "reference/normalization.hpp"

namespace flowdlo::train {
namespace {

Point3 turned(const Eigen::Matrix2f& turn, const Point3& point) {
  const Eigen::Vector2f xy = turn * Eigen::Vector2f(point.x, point.y);
  return {xy.x(), xy.y(), point.z};
}

void put_row(std::span<float> rows, std::size_t row, const Point3& point, float last) {
  rows[row * 4] = point.x;
  rows[row * 4 + 1] = point.y;
  rows[row * 4 + 2] = point.z;
  rows[row * 4 + 3] = last;
}

Centerline turned(const Eigen::Matrix2f& turn, Centerline nodes) {
  for (Point3& node : nodes) node = turned(turn, node);
  return nodes;
}

/// Sec. 3.3 in the turned camera; `support` follows.
void make_canonical(PriorState& prior) {
  if (prior::is_canonical(prior.nodes)) return;
  std::reverse(prior.nodes.begin(), prior.nodes.end());
  std::reverse(prior.support.begin(), prior.support.end());
}

Centerline directed(Centerline truth, const Centerline& prior, TruthDirection direction) {
  Centerline reversed = truth;
  std::reverse(reversed.begin(), reversed.end());
  if (direction == TruthDirection::kCanonical) {
    return prior::is_canonical(truth) ? truth : reversed;
  }
  return index_error(prior, reversed) < index_error(prior, truth) ? reversed : truth;
}

}  // namespace

Eigen::Matrix2f Turn::matrix() const {
  const auto cosine = static_cast<float>(std::cos(angle_rad));
  const auto sine = static_cast<float>(std::sin(angle_rad));
  const float x = mirrored ? -1.0F : 1.0F;
  Eigen::Matrix2f matrix;
  matrix << x * cosine, -sine, x * sine, cosine;
  return matrix;
}

double index_error(const Centerline& estimate, const Centerline& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double x = static_cast<double>(estimate[i].x) - static_cast<double>(truth[i].x);
    const double y = static_cast<double>(estimate[i].y) - static_cast<double>(truth[i].y);
    const double z = static_cast<double>(estimate[i].z) - static_cast<double>(truth[i].z);
    sum += std::sqrt(x * x + y * y + z * z);
  }
  return sum / kNodes;
}

GlobalNorm global_norm(std::span<const Record> records) {
  const double count = static_cast<double>(records.size()) * kNodes;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Record& record : records) {
    for (const Point3& p : record.truth) mean += Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
  }
  mean /= count;  // Eq. (3.8)
  double square = 0;
  for (const Record& record : records) {
    for (const Point3& p : record.truth) {
      square += (Eigen::Vector3f(p.x, p.y, p.z).cast<double>() - mean).squaredNorm();
    }
  }
  const Eigen::Vector3f rounded = mean.cast<float>();
  return {{rounded.x(), rounded.y(), rounded.z()},
          static_cast<float>(std::sqrt(square / count))};  // Eq. (3.9)
}

RecordView::RecordView(const Record& record, std::size_t prior, const Turn& turn,
                       const ViewConfig& config)
    : record_(record), turn_(turn.matrix()) {
  field_.reset(record.mask);

  std::array<float, kPoints * 4> points{};
  for (std::size_t i = 0; i < kPoints; ++i) {
    put_row(points, i, turned(turn_, record.visible.points_cam[i]),
            static_cast<float>(record.visible.valid[i]));
  }
  if (config.normalization == weights::NormalizationKind::kFrame) {
    reference::frame_normalization(points, norm_);
  } else {
    const auto& mean = config.global.mean;
    norm_ = {mean[0], mean[1], mean[2], config.global.scale};
  }
  reference::normalize(points, norm_, points_);

  PriorState state = record.priors[prior];
  state.nodes = turned(turn_, state.nodes);
  make_canonical(state);
  const Centerline truth =
      directed(turned(turn_, record.truth), state.nodes, config.truth_direction);
  std::array<float, kNodes * 4> rows{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    put_row(rows, i, state.nodes[i], static_cast<float>(state.support[i]));
  }
  reference::normalize(rows, norm_, prior_);
  for (std::size_t i = 0; i < kNodes; ++i) put_row(rows, i, truth[i], 0.0F);
  reference::normalize(rows, norm_, truth_);
}

void RecordView::features(std::span<const float> state, std::span<float> out) const {
  const Intrinsics& camera = record_.camera;
  ops::FrameParams params{};
  params.fx = camera.fx;
  params.fy = camera.fy;
  params.cx = camera.cx;
  params.cy = camera.cy;
  params.width = static_cast<float>(record_.mask.width);
  params.height = static_cast<float>(record_.mask.height);
  params.field_width = static_cast<float>(field_.width());
  params.field_height = static_cast<float>(field_.height());

  const Eigen::Matrix2f back = turn_.transpose();
  std::array<float, kNodes * 4> unturned{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Point3 point = turned(back, Point3{state[i * 4], state[i * 4 + 1], state[i * 4 + 2]});
    put_row(unturned, i, point, 0.0F);
  }
  const Point3 mean = turned(back, Point3{norm_[0], norm_[1], norm_[2]});
  const std::array<float, 4> norm{mean.x, mean.y, mean.z, norm_[3]};

  const float aspect = camera.fx / camera.fy;
  const auto texel = [&](int row, int column) {
    auto value = field_.texel(row, column);
    const float du = value[2];
    const float dv = value[3];
    value[2] = turn_(0, 0) * du + turn_(0, 1) * aspect * dv;
    value[3] = turn_(1, 0) / aspect * du + turn_(1, 1) * dv;
    return value;
  };
  reference::mask_features_of(unturned, norm, params, texel, record_.depth_m, out);
}

}  // namespace flowdlo::train
