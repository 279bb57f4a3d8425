#include "baselines/trackdlo_init.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "baselines/chain_merge.hpp"
#include "baselines/chains.hpp"
#include "baselines/mode_filter.hpp"
#include "baselines/smoothing_spline.hpp"
#include "baselines/zhang_suen.hpp"

namespace flowdlo::baselines {
namespace {

constexpr int kModeSize_px = 15;
constexpr double kSmoothing_m2 = 0.0005;
constexpr int kLengthSamples = 300;
constexpr double kSamplesAMetre = 1000;
constexpr double kFarthestFromMask_px = 3;  // Sec. 4.1.4

using Points = std::vector<Eigen::Vector3d>;

// Point 8: the depth of exactly that pixel, in whole millimetres as the sensor's topic has it.
Points lifted(const Chain& chain, const FrameFolder& folder) {
  const Intrinsics& camera = folder.intrinsics;
  Points points;
  for (const cv::Point& pixel : chain) {
    const auto i = static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(folder.width) +
                   static_cast<std::size_t>(pixel.x);
    const auto depth_m = static_cast<double>(folder.depth_m[i]);
    const double z = std::isfinite(depth_m) ? std::round(depth_m * 1000) / 1000 : 0;
    if (!(z > 0)) continue;
    points.emplace_back((pixel.x - static_cast<double>(camera.cx)) * z / camera.fx,
                        (pixel.y - static_cast<double>(camera.cy)) * z / camera.fy, z);
  }
  return points;
}

Points sampled(const CubicSpline& spline, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(spline.at(count > 1 ? static_cast<double>(i) / (count - 1) : 0.0));
  }
  return points;
}

double length_m(const Points& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

// Point 9. False where the spline is shorter than a sample.
bool nodes_of(const CubicSpline& spline, Centerline& nodes) {
  const double length = length_m(sampled(spline, kLengthSamples));
  const Points points = sampled(spline, static_cast<int>(kSamplesAMetre * length));
  if (points.empty()) return false;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double place = static_cast<double>(i) * static_cast<double>(points.size() - 1);
    const Eigen::Vector3f p = points[static_cast<std::size_t>(place / (kNodes - 1))].cast<float>();
    nodes[i] = {p.x(), p.y(), p.z()};
  }
  return true;
}

Result<Chain> ordered_pixels(const cv::Mat& mask, bool repaired) {
  const cv::Mat skeleton = zhang_suen(mode_filtered(mask, kModeSize_px));
  auto chains = pruned(chains_of(skeleton), repaired);
  if (!chains) return chains.error();
  return merged(*chains, repaired);
}

}  // namespace

Attempt checked(const Centerline& nodes, const cv::Mat& mask, const Intrinsics& camera) {
  const auto invalid = [&](const char* reason) { return Attempt{Status::kInvalid, reason, nodes}; };
  cv::Mat away;
  cv::distanceTransform(mask == 0, away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  double sum = 0;
  for (const Point3& node : nodes) {
    if (!std::isfinite(node.x) || !std::isfinite(node.y) || !std::isfinite(node.z)) {
      return invalid("a node is not finite");
    }
    if (!(node.z > 0)) return invalid("a node is not in front of the camera");
    const long u = std::lround(camera.fx * node.x / node.z + camera.cx);
    const long v = std::lround(camera.fy * node.y / node.z + camera.cy);
    if (u < 0 || v < 0 || u >= mask.cols || v >= mask.rows) {
      return invalid("a node projects outside the image");
    }
    sum += static_cast<double>(away.at<float>(static_cast<int>(v), static_cast<int>(u)));
  }
  if (sum / kNodes > kFarthestFromMask_px) return invalid("nodes lie off the mask");
  return {Status::kValid, {}, nodes};
}

Attempt trackdlo_init(const Observation& observation, bool repaired) {
  const cv::Mat mask = hsv_mask(observation);
  if (cv::countNonZero(mask) == 0) return no_output("mask is empty");
  const auto pixels = ordered_pixels(mask, repaired);
  if (!pixels) return no_output(pixels.error().message);
  Points points = lifted(*pixels, observation.folder);
  if (repaired) points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 4) return no_output("fewer than 4 points with depth");
  const auto spline = smoothing_spline(points, kSmoothing_m2);
  if (!spline) return no_output("repeated points in the spline fit");
  Centerline nodes{};
  if (!nodes_of(*spline, nodes)) return no_output("spline shorter than a millimetre");
  return checked(nodes, mask, observation.folder.intrinsics);
}

}  // namespace flowdlo::baselines
