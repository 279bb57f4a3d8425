#include "baselines/traced_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "baselines/smoothing_spline.hpp"
#include "baselines/zhang_suen.hpp"

namespace flowdlo::baselines {
namespace {

constexpr double kShortest_px = 10;
constexpr double kDistanceWeight = 0.05;
constexpr double kTurnWeight = 0.95;
constexpr double kDirectionSpan_px = 5;
constexpr double kPieceLength_px = 20;  // of the spline
constexpr int kMostPieces = 60;
constexpr double kPi = 3.14159265358979323846;

struct Link {
  double cost;
  std::size_t a;  // tips: 2 * stroke, + 1 at its last point
  std::size_t b;
};

cv::Point2f tip(const std::vector<Stroke>& strokes, std::size_t index) {
  const Stroke& stroke = strokes[index / 2];
  return index % 2 == 1 ? stroke.back() : stroke.front();
}

double heading(const std::vector<Stroke>& strokes, std::size_t index) {
  const cv::Point2f out = direction_out(strokes[index / 2], index % 2 == 1, 0, kDirectionSpan_px);
  return std::atan2(static_cast<double>(out.y), static_cast<double>(out.x));
}

std::vector<Link> links_of(const std::vector<Stroke>& strokes) {
  std::vector<Link> links;
  for (std::size_t a = 0; a < 2 * strokes.size(); ++a) {
    for (std::size_t b = a + 1; b < 2 * strokes.size(); ++b) {
      if (a / 2 == b / 2) continue;
      double between = std::abs(heading(strokes, a) - heading(strokes, b));
      if (between > kPi) between = 2 * kPi - between;
      const double turn = std::abs(kPi - between);  // 0 where one goes on as the other came
      const double away = cv::norm(tip(strokes, a) - tip(strokes, b));
      links.push_back({kDistanceWeight * away + kTurnWeight * turn, a, b});
    }
  }
  std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
    return std::tie(x.cost, x.a, x.b) < std::tie(y.cost, y.a, y.b);
  });
  return links;
}

// The partner of each tip, or its own index.
std::vector<std::size_t> paired_tips(const std::vector<Stroke>& strokes) {
  std::vector<std::size_t> partner(2 * strokes.size());
  std::vector<std::size_t> chain(strokes.size());
  for (std::size_t i = 0; i < partner.size(); ++i) partner[i] = i;
  for (std::size_t i = 0; i < chain.size(); ++i) chain[i] = i;
  for (const Link& link : links_of(strokes)) {
    const std::size_t one = chain[link.a / 2];
    const std::size_t other = chain[link.b / 2];
    if (partner[link.a] != link.a || partner[link.b] != link.b || one == other) continue;
    partner[link.a] = link.b;
    partner[link.b] = link.a;
    std::replace(chain.begin(), chain.end(), other, one);
  }
  return partner;
}

Stroke joined(const std::vector<Stroke>& strokes) {
  const auto partner = paired_tips(strokes);
  std::size_t at = 0;
  while (partner[at] != at) ++at;  // every link left out would have closed the one chain
  Stroke path;
  for (;;) {
    Stroke piece = strokes[at / 2];
    if (at % 2 == 1) std::reverse(piece.begin(), piece.end());
    path.insert(path.end(), piece.begin(), piece.end());
    const std::size_t out = at % 2 == 1 ? at - 1 : at + 1;
    if (partner[out] == out) return path;
    at = partner[out];
  }
}

Stroke splined(const Stroke& path) {
  const double length = length_px(path);
  Eigen::MatrixXd points(static_cast<Eigen::Index>(path.size()), 2);
  std::vector<double> parameters;
  double along = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) along += cv::norm(path[i] - path[i - 1]);
    parameters.push_back(along / length);
    points.row(static_cast<Eigen::Index>(i)) << static_cast<double>(path[i].x),
        static_cast<double>(path[i].y);
  }
  const int pieces = std::clamp(static_cast<int>(length / kPieceLength_px), 1, kMostPieces);
  const CubicSpline spline = least_squares_spline(points, parameters, pieces);
  const int samples = std::max(2, static_cast<int>(length));
  Stroke result;
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector2d p = spline.at(static_cast<double>(i) / (samples - 1));
    result.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  return result;
}

}  // namespace

Result<Stroke> dloftbs_path(const cv::Mat& mask) {
  const cv::Mat skeleton = zhang_suen(mask);
  auto strokes = strokes_of(skeleton, junction_pixels(skeleton));
  strokes.erase(
      std::remove_if(strokes.begin(), strokes.end(),
                     [](const Stroke& stroke) { return length_px(stroke) < kShortest_px; }),
      strokes.end());
  if (strokes.empty()) return Error{ErrorCode::kNoPath, "no segment of 10 px"};
  return splined(joined(strokes));
}

}  // namespace flowdlo::baselines
