#include "train/sparse_field.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "evidence/mask_field.hpp"

namespace flowdlo::train {
namespace {

constexpr double kSmoothingSigma_px = 2.5;  // of the engine's mask field
constexpr int kTaps = 21;                   // of OpenCV's kernel for that sigma on floats
constexpr int kReach = kTaps / 2;

const std::array<float, kTaps>& gaussian_taps() {
  static const std::array<float, kTaps> taps = [] {
    std::array<float, kTaps> values{};
    const cv::Mat1f kernel = cv::getGaussianKernel(kTaps, kSmoothingSigma_px, CV_32F);
    std::copy_n(kernel.begin(), kTaps, values.begin());
    return values;
  }();
  return taps;
}

}  // namespace

void SparseField::fill_share(const MaskRuns& mask) {
  share_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F);
  if (mask.width % 2 == 0 && mask.height % 2 == 0) {  // area average: a quarter for each pixel
    for (const MaskRun& run : mask.runs) {
      float* const row = share_.data() + static_cast<std::size_t>(run.v / 2) * width_;
      for (int u = run.u; u < run.u + run.length; ++u) row[u / 2] += 0.25F;
    }
    return;
  }
  const auto image = image_of(mask);
  const auto field = evidence::mask_field({mask.width, mask.height, {}, {}, image, {}});
  for (std::size_t i = 0; i < share_.size(); ++i) share_[i] = field.texels[4 * i];
}

void SparseField::collect_border() {
  border_u_.clear();
  border_v_.clear();
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) {
      if (!(share(v, u) > 0)) continue;
      const bool inner = v > 0 && v + 1 < height_ && u > 0 && u + 1 < width_ &&
                         share(v - 1, u) > 0 && share(v + 1, u) > 0 && share(v, u - 1) > 0 &&
                         share(v, u + 1) > 0;
      if (inner) continue;
      border_u_.push_back(static_cast<float>(u));
      border_v_.push_back(static_cast<float>(v));
    }
  }
}

void SparseField::reset(const MaskRuns& mask) {
  width_ = std::max(1, mask.width / 2);
  height_ = std::max(1, mask.height / 2);
  fill_share(mask);
  collect_border();
}

float SparseField::smoothed(int row, int column) const {
  const auto& taps = gaussian_taps();
  float sum = 0;
  for (int dv = std::max(-kReach, -row); dv <= std::min(kReach, height_ - 1 - row); ++dv) {
    float line = 0;
    for (int du = std::max(-kReach, -column); du <= std::min(kReach, width_ - 1 - column); ++du) {
      line += taps[static_cast<std::size_t>(du + kReach)] * share(row + dv, column + du);
    }
    sum += taps[static_cast<std::size_t>(dv + kReach)] * line;
  }
  return sum;
}

std::array<float, 2> SparseField::displacement(int row, int column) const {
  if (share(row, column) > 0) return {0, 0};
  if (border_u_.empty()) return {static_cast<float>(width_), static_cast<float>(width_)};
  const auto u = static_cast<float>(column);
  const auto v = static_cast<float>(row);
  using Values = Eigen::Map<const Eigen::ArrayXf>;
  const auto count = static_cast<Eigen::Index>(border_u_.size());
  // Exact: integers below 2^24.
  const float least = ((Values(border_u_.data(), count) - u).square() +
                       (Values(border_v_.data(), count) - v).square())
                          .minCoeff();
  const auto square = [&](std::size_t i) {
    const float du = border_u_[i] - u;
    const float dv = border_v_[i] - v;
    return du * du + dv * dv;
  };
  std::size_t nearest = 0;  // the first of equally near ones: the upper, then the left one
  while (square(nearest) != least) ++nearest;
  return {border_u_[nearest] - u, border_v_[nearest] - v};
}

std::array<float, 4> SparseField::texel(int row, int column) const {
  const auto [du, dv] = displacement(row, column);
  constexpr float kFar_px = kReach * 1.5F;  // beyond the window's corners
  const bool near = du * du + dv * dv < kFar_px * kFar_px;
  return {share(row, column), near ? smoothed(row, column) : 0.0F, du, dv};
}

}  // namespace flowdlo::train
