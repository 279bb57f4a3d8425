// RecordView: a record as one draw sees it, in normalised space, after turning the camera.
//
// Turning the camera about its optical axis (and looking at it in a mirror) moves truth, prior and
// visible points by one orthogonal map, and the mask by its homography H = K R K^-1, Sec. 4.1.3.
// The local features are read from the unturned mask at H^-1 u, and their displacement is turned:
// what the engine would compute on the turned image, had its border turned with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "ops/program.hpp"
#include "train/recipe.hpp"
#include "train/record.hpp"
#include "train/sparse_field.hpp"

namespace flowdlo::train {

inline constexpr std::size_t kPoints = evidence::kVisiblePoints;
inline constexpr std::size_t kFeatureColumns = 8;  ///< of ops::MaskFeatures

/// Rotation about the optical axis by `angle_rad`, after x is negated where `mirrored`.
struct Turn {
  double angle_rad = 0;
  bool mirrored = false;

  [[nodiscard]] Eigen::Matrix2f matrix() const;
};

/// mu and sigma_iso of Eq. (3.8), (3.9).
struct GlobalNorm {
  std::array<float, 3> mean{};
  float scale = 1;
};

/// Over the truth of all `records`.
[[nodiscard]] GlobalNorm global_norm(std::span<const Record> records);

struct ViewConfig {
  weights::NormalizationKind normalization = weights::NormalizationKind::kFrame;
  GlobalNorm global;
  TruthDirection truth_direction = TruthDirection::kPrior;
};

class RecordView {
 public:
  /// `prior` is an index in record.priors. The record must outlive the view.
  RecordView(const Record& record, std::size_t prior, const Turn& turn, const ViewConfig& config);

  /// [64, 4] normalised prior, and support; as the engine's model sees it.
  [[nodiscard]] std::span<const float> prior() const { return prior_; }
  /// [256, 4] normalised visible points, and validity.
  [[nodiscard]] std::span<const float> points() const { return points_; }
  /// [64, 4] normalised truth x_1, and zero.
  [[nodiscard]] std::span<const float> truth() const { return truth_; }
  /// [4] mean and scale of Eq. (3.10), turned camera frame.
  [[nodiscard]] std::span<const float> norm() const { return norm_; }

  /// phi_M at the projections of a normalised state [64, 4]: out [64, 8].
  void features(std::span<const float> state, std::span<float> out) const;

 private:
  const Record& record_;
  Eigen::Matrix2f turn_;
  SparseField field_;
  std::array<float, kNodes * 4> prior_{};
  std::array<float, kPoints * 4> points_{};
  std::array<float, kNodes * 4> truth_{};
  std::array<float, 4> norm_{};
};

/// Mean distance of corresponding nodes, Eq. (4.1), in the nodes' unit.
[[nodiscard]] double index_error(const Centerline& estimate, const Centerline& truth);

}  // namespace flowdlo::train
