#include "strand/sample.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mat/mat_image.hpp"
#include "strand/color_faults.hpp"
#include "strand/depth_faults.hpp"
#include "strand/dice.hpp"
#include "strand/mask_faults.hpp"
#include "strand/targets.hpp"

namespace flowdlo::strand {
namespace {

constexpr float kDense_px = 0.5F;  // between points of a strand in a sample

cv::Mat view_of(int height, int width, int type, const void* data) {
  return {height, width, type, const_cast<void*>(data)};
}

/// A patch turned, mirrored and scaled about a place of its own.
struct Placing {
  float scale = 1;
  float angle = 0;
  bool mirrored = false;
  cv::Point2f from;  ///< pixels of the patch
  cv::Point2f to;    ///< pixels of the sample

  [[nodiscard]] cv::Point2f operator()(float u, float v) const {
    float x = scale * (u - from.x);
    const float y = scale * (v - from.y);
    if (mirrored) x = -x;
    return {std::cos(angle) * x - std::sin(angle) * y + to.x,
            std::sin(angle) * x + std::cos(angle) * y + to.y};
  }
  [[nodiscard]] cv::Matx23f matrix() const {
    const cv::Point2f o = (*this)(0, 0);
    const cv::Point2f x = (*this)(1, 0);
    const cv::Point2f y = (*this)(0, 1);
    return {x.x - o.x, y.x - o.x, o.x, x.y - o.y, y.y - o.y, o.y};
  }
};

Placing draw_placing(const Patch& patch, int size_px, const SpoilConfig& config, Dice& dice) {
  Placing placing;
  const auto wrong = static_cast<float>(config.width_wrong);
  const float believed = dice.chance(config.width_wrong_share)
                             ? dice.factor(1 / wrong, wrong)
                             : std::exp(static_cast<float>(config.width_spread) * dice.gaussian());
  placing.scale =
      std::min(field::kRope_px / (patch.rope_px * believed), field::kMostScale / patch.frame_scale);
  const bool upright = dice.chance(0.5);
  placing.angle =
      upright ? 0.5F * kPi * static_cast<float>(dice.integer(0, 3)) : dice.uniform(0, 2 * kPi);
  placing.mirrored = dice.chance(0.5);
  const auto middle = 0.5F * static_cast<float>(size_px - 1);
  const float shift = 0.12F * static_cast<float>(size_px);
  placing.from = {0.5F * static_cast<float>(patch.width - 1),
                  0.5F * static_cast<float>(patch.height - 1)};
  placing.to = {middle + dice.uniform(-shift, shift), middle + dice.uniform(-shift, shift)};
  return placing;
}

std::vector<Strand> placed(const std::vector<Strand>& strands, const Placing& placing) {
  std::vector<Strand> result = strands;
  for (std::size_t s = 0; s < strands.size(); ++s) {
    std::vector<AxisPoint> points;
    for (AxisPoint point : strands[s].points) {
      const cv::Point2f at = placing(point.u, point.v);
      point.u = at.x;
      point.v = at.y;
      point.radius_px *= placing.scale;
      if (!points.empty()) {
        const AxisPoint before = points.back();
        const float px = std::hypot(point.u - before.u, point.v - before.v);
        const int pieces = std::max(1, static_cast<int>(std::ceil(px / kDense_px)));
        for (int k = 1; k < pieces; ++k) {
          const float t = static_cast<float>(k) / static_cast<float>(pieces);
          AxisPoint between = 2 * k < pieces ? before : point;
          between.u = before.u + t * (point.u - before.u);
          between.v = before.v + t * (point.v - before.v);
          between.depth_m = before.depth_m + t * (point.depth_m - before.depth_m);
          between.along_widths =
              before.along_widths + t * (point.along_widths - before.along_widths);
          points.push_back(between);
        }
      }
      points.push_back(point);
    }
    result[s].points = std::move(points);
  }
  return result;
}

cv::Mat warped(const cv::Mat& image, const Placing& placing, int size_px) {
  cv::Mat small = image;
  Placing rest = placing;
  if (placing.scale < 0.9F) {  // so that nothing is skipped
    const cv::Size size(
        std::max(1, static_cast<int>(std::lround(static_cast<float>(image.cols) * placing.scale))),
        std::max(1, static_cast<int>(std::lround(static_cast<float>(image.rows) * placing.scale))));
    cv::resize(image, small, size, 0, 0, cv::INTER_AREA);
    const float by_u = static_cast<float>(size.width) / static_cast<float>(image.cols);
    const float by_v = static_cast<float>(size.height) / static_cast<float>(image.rows);
    rest.scale = 1;
    rest.from = {(placing.from.x + 0.5F) * by_u - 0.5F, (placing.from.y + 0.5F) * by_v - 0.5F};
  }
  cv::Mat result;
  cv::warpAffine(small, result, rest.matrix(), {size_px, size_px}, cv::INTER_LINEAR,
                 cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return result;
}

/// A field::Sight that OpenCV can change.
struct Scene {
  cv::Mat color;
  cv::Mat mask;
  cv::Mat depth_m;
  cv::Mat inside;
  float focal_px = 0;
};

field::Sight sight_of(const Scene& scene) {
  return {mat::image_of<field::Color>(scene.color), mat::image_of<float>(scene.mask),
          mat::image_of<float>(scene.depth_m), mat::image_of<float>(scene.inside), scene.focal_px};
}

Scene scene_of(const Patch& patch, const Placing& placing, int size_px) {
  Scene sight;
  sight.focal_px = patch.focal_px * placing.scale;
  cv::Mat image;
  view_of(patch.height, patch.width, CV_8UC3, patch.color_bgr.data())
      .convertTo(image, CV_32F, 1.0 / 255);
  sight.color = warped(image, placing, size_px);
  view_of(patch.height, patch.width, CV_8UC1, patch.mask.data())
      .convertTo(image, CV_32F, 1.0 / 255);
  sight.mask = warped(image, placing, size_px);
  sight.inside = warped(cv::Mat::ones(patch.height, patch.width, CV_32F), placing, size_px);
  cv::threshold(sight.inside, sight.inside, 0.99, 1, cv::THRESH_BINARY);
  view_of(patch.height, patch.width, CV_16UC1, patch.depth.data())
      .convertTo(image, CV_32F, synth::kDepthScale_m);
  cv::Mat known;
  cv::threshold(image, known, 0, 1, cv::THRESH_BINARY);
  const cv::Mat share = warped(known, placing, size_px);
  sight.depth_m = warped(image, placing, size_px) / cv::max(share, 1e-3);
  sight.depth_m.setTo(0, share <= 0.5);
  return sight;
}

}  // namespace

Sample sample_of(const Patch& patch, int size_px, std::uint64_t seed, std::uint64_t number,
                 const SpoilConfig& config) {
  Dice dice(seed, number);
  const Placing placing = draw_placing(patch, size_px, config, dice);
  const auto strands = placed(patch.strands, placing);
  const Targets truth = targets_of(strands, patch.focal_px * placing.scale, {size_px, size_px});
  Scene sight = scene_of(patch, placing, size_px);
  const cv::Mat taken = spoil_mask(strands, dice, sight.mask);
  const bool alone = dice.chance(config.mask_alone);
  if (alone || dice.chance(config.no_color)) {
    sight.color = cv::Mat();
  } else {
    spoil_colors(truth, config, patch.frame_scale * placing.scale, dice, sight.color);
  }
  bool beside = !sight.color.empty();  // whether anything shows beside the mask
  if (alone || dice.chance(config.no_depth)) {
    sight.depth_m.setTo(0);
  } else if (config.level > 0 && dice.chance(config.level)) {
    sight.depth_m.setTo(cv::mean(sight.depth_m, sight.depth_m > 0));
  } else if (config.mask_depth > 0 && dice.chance(config.mask_depth)) {
    spoil_depth(sight.focal_px, dice, sight.depth_m);
    keep_depth_of_mask(sight.mask, dice, sight.depth_m);
  } else {
    spoil_depth(sight.focal_px, dice, sight.depth_m);
    beside = true;
  }
  // Nobody can know of what a mask lacks where nothing shows beside it.
  if (!beside && !taken.empty()) sight.mask = cv::max(sight.mask, taken);
  Sample sample{mat::mat_of(field::input_of(sight_of(sight))), truth.field};
  // Beyond the image nothing is known, and nothing is asked.
  for (int v = 0; v < size_px; ++v) {
    for (int u = 0; u < size_px; ++u) {
      if (sight.inside.at<float>(v, u) > 0) continue;
      float* const to = sample.target.ptr<float>(v) + u * field::kChannels;
      std::fill(to, to + field::kChannels, 0.0F);
    }
  }
  return sample;
}

}  // namespace flowdlo::strand
