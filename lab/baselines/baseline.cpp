#include "baselines/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "baselines/traced_path.hpp"
#include "baselines/trackdlo_init.hpp"
#include "baselines/zhang_suen.hpp"
#include "evidence/visible_points.hpp"
#include "geometry/quantile.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "prior/refined_prior.hpp"

namespace flowdlo::baselines {
namespace {

enum class Lift { kThesis, kRefined };

// Median over the skeleton.
float rope_width_px(const cv::Mat& mask) {
  const cv::Mat skeleton = zhang_suen(mask);
  cv::Mat away;
  cv::distanceTransform(mask, away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  std::vector<float> distances;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (skeleton.at<std::uint8_t>(v, u) != 0) distances.push_back(away.at<float>(v, u));
    }
  }
  if (distances.empty()) return 1;
  return path::width_at(geometry::median_of(distances));
}

path::Path path_of(const Stroke& stroke, float width_px) {
  path::Path path;
  for (const cv::Point2f& point : stroke) {
    const Eigen::Vector2f pixel(point.x, point.y);
    if (path.points_px.empty() || pixel != path.points_px.back()) path.points_px.push_back(pixel);
  }
  path.bridged.assign(path.points_px.size(), 0);
  path.width_px = width_px;
  return path;
}

Attempt lifted(const Observation& observation, Result<Stroke> (*trace)(const cv::Mat&), Lift lift) {
  const Frame frame = observation.folder.frame();
  const cv::Mat mask = frame_mask(observation.folder);
  if (cv::countNonZero(mask) == 0) return no_output("mask is empty");
  const auto stroke = trace(mask);
  if (!stroke) return no_output(stroke.error().message);
  const float width_px = rope_width_px(mask);
  const path::Path path = path_of(*stroke, width_px);
  const auto cloud = evidence::unproject(frame);
  const auto visible = evidence::visible_points(cloud);
  const auto prior = lift == Lift::kThesis ? prior::lift(path, visible, frame)
                                           : prior::refine(path, width_px, cloud, visible, frame);
  if (!prior) {
    return no_output(prior.error().code == ErrorCode::kNoEvidence ? "no depth along the path"
                                                                  : "path of one point");
  }
  return {Status::kValid, {}, prior->nodes};
}

Attempt faithful(const Observation& seen) { return trackdlo_init(seen, false); }
Attempt repaired(const Observation& seen) { return trackdlo_init(seen, true); }
Attempt geodesic(const Observation& seen) { return lifted(seen, geodesic_path, Lift::kThesis); }
Attempt mbest(const Observation& seen) { return lifted(seen, mbest_path, Lift::kRefined); }
Attempt dloftbs(const Observation& seen) { return lifted(seen, dloftbs_path, Lift::kRefined); }

constexpr std::array<Baseline, 5> kBaselines{
    {{"trackdlo", "TrackDLO-init", true, faithful},
     {"trackdlo-repaired", "TrackDLO-init, repaired", true, repaired},
     {"geodesic", "geodesic prior", false, geodesic},
     {"mbest", "mBEST-like path", false, mbest},
     {"dloftbs", "DLOFTBs-like path", false, dloftbs}}};

}  // namespace

std::span<const Baseline> all_baselines() { return kBaselines; }

const Baseline* find_baseline(const std::string& name) {
  for (const Baseline& baseline : all_baselines()) {
    if (baseline.name == (name == "trackdlo-init" ? "trackdlo" : name)) {
      return &baseline;
    }
  }
  return nullptr;
}

Result<std::vector<const Baseline*>> choose_baselines(const std::vector<std::string>& names) {
  std::vector<const Baseline*> chosen;
  std::string unknown;
  for (const std::string& name : names) {
    if (name == "prior") continue;
    const Baseline* found = find_baseline(name);
    if (found == nullptr && name != "all") unknown += fmt::format(" \"{}\"", name);
    for (const Baseline& baseline : all_baselines()) {
      const bool wanted = name == "all" || &baseline == found;
      const bool here = std::find(chosen.begin(), chosen.end(), &baseline) != chosen.end();
      if (wanted && !here) chosen.push_back(&baseline);
    }
  }
  if (unknown.empty()) return chosen;
  std::string known;
  for (const Baseline& baseline : all_baselines()) known += fmt::format("{}, ", baseline.name);
  return Error{
      ErrorCode::kBadInput,
      fmt::format("--baselines: expected names of {}prior, or all; got{}", known, unknown)};
}

}  // namespace flowdlo::baselines
