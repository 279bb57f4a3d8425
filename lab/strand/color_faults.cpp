#include "strand/color_faults.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "field/sight.hpp"
#include "strand/noise.hpp"

namespace flowdlo::strand {
namespace {

cv::Vec3f any_color(Dice& dice) {
  return {dice.uniform(0, 1), dice.uniform(0, 1), dice.uniform(0, 1)};
}

template <class Change>
void on_rope(const Targets& truth, cv::Mat& color, Change change) {
  for (int v = 0; v < color.rows; ++v) {
    for (int u = 0; u < color.cols; ++u) {
      const float off = truth.off.at<float>(v, u);
      if (std::abs(off) < 1.05F)
        change(color.at<cv::Vec3f>(v, u), truth.along.at<float>(v, u), off);
    }
  }
}

/// Twisted, braided, with bands, a tracer thread, flat, or darker towards its sides.
void dress_rope(const Targets& truth, Dice& dice, cv::Mat& color) {
  if (dice.chance(0.15)) {  // another material altogether
    const cv::Vec3f paint = any_color(dice);
    const float share = dice.uniform(0.4F, 1);
    on_rope(truth, color, [&](cv::Vec3f& c, float, float) {
      const float light = (c[0] + c[1] + c[2]) / 3 + 0.2F;
      c = (1 - share) * c + share * light * paint;
    });
  }
  if (dice.chance(0.5)) {
    const float pitch = dice.factor(0.3F, 3) * (dice.chance(0.5) ? 1.0F : -1.0F);
    const float slant = dice.uniform(-0.8F, 0.8F);
    const float phase = dice.uniform(0, 1);
    const bool sharp = dice.chance(0.5);
    const bool braided = dice.chance(0.4);
    const float other_pitch = -dice.factor(0.3F, 3);
    const float other_slant = dice.uniform(-0.8F, 0.8F);
    const float depth = dice.uniform(0.05F, 0.5F);
    const cv::Vec3f tint(dice.uniform(0.5F, 1), dice.uniform(0.5F, 1), dice.uniform(0.5F, 1));
    on_rope(truth, color, [&](cv::Vec3f& c, float along, float off) {
      float wave = std::sin(2 * kPi * (along * pitch + off * slant + phase));
      if (sharp) wave = std::copysign(std::pow(std::abs(wave), 0.3F), wave);
      if (braided) wave *= std::sin(2 * kPi * (along * other_pitch + off * other_slant));
      c = c.mul(cv::Vec3f::all(1) + depth * wave * tint);
    });
  }
  if (dice.chance(0.12)) {  // bands around it
    const float each = dice.uniform(0.03F, 0.5F);
    const float level = dice.uniform(-0.5F, 0.9F);
    const float share = dice.uniform(0, 1);
    const cv::Vec3f paint = any_color(dice);
    on_rope(truth, color, [&](cv::Vec3f& c, float along, float) {
      if (std::sin(2 * kPi * along * each) > level) c = (1 - share) * c + share * paint;
    });
  }
  if (dice.chance(0.12)) {  // a thread along it
    const float where = dice.uniform(-0.7F, 0.7F);
    const float half = dice.uniform(0.1F, 0.3F);
    const float share = dice.uniform(0.2F, 0.9F);
    const cv::Vec3f paint = any_color(dice);
    on_rope(truth, color, [&](cv::Vec3f& c, float, float off) {
      if (std::abs(off - where) < half) c = (1 - share) * c + share * paint;
    });
  }
  if (dice.chance(0.3)) {  // light that falls off, or rims
    const float fall = dice.uniform(-0.25F, 0.65F);
    on_rope(truth, color,
            [&](cv::Vec3f& c, float, float off) { c *= 1 - fall * std::min(off * off, 1.0F); });
  }
  if (dice.chance(0.25)) {  // little shading left: overexposed, or matte under a white sky
    cv::Vec3f sum(0, 0, 0);
    int count = 0;
    on_rope(truth, color, [&](cv::Vec3f& c, float, float) {
      sum += c;
      ++count;
    });
    const cv::Vec3f mean = count > 0 ? sum / count : sum;
    const float share = dice.uniform(0, 1);
    on_rope(truth, color, [&](cv::Vec3f& c, float, float) { c = (1 - share) * c + share * mean; });
  }
}

/// Lines, cables, seams of boards and prints that are no rope of ours, below it.
void dress_ground(const Targets& truth, Dice& dice, cv::Mat& color) {
  cv::Mat painted = color.clone();
  const int size = color.cols;
  if (dice.chance(0.3)) {  // the rope's own colour
    const cv::Mat patchy = smooth_noise(size, static_cast<double>(dice.uniform(6, 40)), dice);
    const float contrast = dice.uniform(0.05F, 0.35F);
    for (int v = 0; v < size; ++v) {
      for (int u = 0; u < size; ++u) {
        painted.at<cv::Vec3f>(v, u) *= std::max(0.0F, 1 + contrast * patchy.at<float>(v, u));
      }
    }
  }
  const int lines = dice.chance(0.35) ? dice.integer(1, 5) : 0;
  const bool parallel = dice.chance(0.4);
  const float common = dice.uniform(0, 2 * kPi);
  for (int k = 0; k < lines; ++k) {
    const auto paint = any_color(dice);
    const cv::Scalar tone(static_cast<double>(paint[0]), static_cast<double>(paint[1]),
                          static_cast<double>(paint[2]));
    float x = dice.uniform(0, static_cast<float>(size));
    float y = dice.uniform(0, static_cast<float>(size));
    float angle = parallel ? common : dice.uniform(0, 2 * kPi);
    const float bend = parallel || dice.chance(0.5) ? 0.0F : dice.uniform(-0.12F, 0.12F);
    const int thick = dice.integer(1, 9);
    x -= 100 * std::cos(angle);
    y -= 100 * std::sin(angle);
    for (int step = 0; step < 60; ++step) {
      const cv::Point from(static_cast<int>(x), static_cast<int>(y));
      x += 5 * std::cos(angle);
      y += 5 * std::sin(angle);
      angle += bend;
      cv::line(painted, from, {static_cast<int>(x), static_cast<int>(y)}, tone, thick);
    }
  }
  if (dice.chance(0.3)) cv::GaussianBlur(painted, painted, {0, 0}, 0.8);
  const float nearness = dice.chance(0.15) ? dice.uniform(0.5F, 1) : 0;  // to the rope's own colour
  cv::Vec3f mean(0, 0, 0);
  int count = 0;
  on_rope(truth, color, [&](cv::Vec3f& c, float, float) {
    mean += c;
    ++count;
  });
  if (count > 0) mean /= count;
  for (int v = 0; v < size; ++v) {
    for (int u = 0; u < size; ++u) {
      if (std::abs(truth.off.at<float>(v, u)) < 1.05F) continue;
      const cv::Vec3f& c = painted.at<cv::Vec3f>(v, u);
      const float light = (c[0] + c[1] + c[2]) / 1.5F;
      color.at<cv::Vec3f>(v, u) = count > 0 ? (1 - nearness) * c + nearness * light * mean : c;
    }
  }
}

void turn_hue(Dice& dice, cv::Mat& color) {
  const float angle = dice.uniform(-kPi, kPi);
  const float c = std::cos(angle);
  const float s = std::sin(angle) / std::sqrt(3.0F);
  const float o = (1 - c) / 3;
  const cv::Matx33f turn(c + o, o - s, o + s, o + s, c + o, o - s, o - s, o + s, c + o);
  cv::transform(color, color, turn);
}

/// What a thing looks like that moves while the shutter is open.
void blur_along(int length_px, float angle, cv::Mat& color) {
  cv::Mat kernel = cv::Mat::zeros(length_px, length_px, CV_32F);
  const auto half = 0.5F * static_cast<float>(length_px - 1);
  cv::line(kernel,
           {static_cast<int>(std::lround(half - half * std::cos(angle))),
            static_cast<int>(std::lround(half - half * std::sin(angle)))},
           {static_cast<int>(std::lround(half + half * std::cos(angle))),
            static_cast<int>(std::lround(half + half * std::sin(angle)))},
           cv::Scalar(1));
  kernel /= cv::sum(kernel)[0];
  cv::filter2D(color, color, -1, kernel);
}

/// A picture that tells little: one colour everywhere, hardly any light, or a long exposure.
/// `pixel_px`: the camera's pixel in pixels of the sample. Shares of 0 draw no dice.
void spoil_picture(const SpoilConfig& config, float pixel_px, Dice& dice, cv::Mat& color) {
  if (config.moved > 0 && dice.chance(config.moved)) {
    const auto most = static_cast<int>(2 * field::kRope_px);
    blur_along(dice.integer(5, most), dice.uniform(0, kPi), color);
  }
  const bool dark = config.dark > 0 && dice.chance(config.dark);
  const bool flat = !dark && config.flat > 0 && dice.chance(config.flat);
  if (!dark && !flat) return;
  if (flat) color.setTo(cv::mean(color));
  if (dark) color *= dice.factor(0.03F, 0.3F);
  add_camera_noise(color, dice.factor(0.5F, 3), pixel_px, dice);
  color = cv::min(cv::max(color, 0), 1);
}

void spoil_color(const SpoilConfig& config, Dice& dice, cv::Mat& color) {
  if (dice.chance(config.grey)) {
    const float a = dice.uniform(0, 1);
    const float b = dice.uniform(0, 1 - a);
    const cv::Matx33f mix(a, b, 1 - a - b, a, b, 1 - a - b, a, b, 1 - a - b);
    cv::transform(color, color, mix);
  } else if (dice.chance(0.75)) {
    turn_hue(dice, color);
  }
  color = cv::max(color, 0);
  cv::pow(color, static_cast<double>(dice.factor(0.6F, 1.65F)), color);
  color *= dice.factor(0.5F, 1.35F);
  const cv::Matx33f balance(dice.factor(0.8F, 1.25F), 0, 0, 0, dice.factor(0.8F, 1.25F), 0, 0, 0,
                            dice.factor(0.8F, 1.25F));
  if (dice.chance(0.5)) cv::transform(color, color, balance);
  if (dice.chance(0.35)) {  // shadows and pools of light
    const cv::Mat light = smooth_noise(color.cols, static_cast<double>(dice.uniform(15, 90)), dice);
    const float contrast = dice.uniform(0, 0.4F);
    for (int v = 0; v < color.rows; ++v) {
      for (int u = 0; u < color.cols; ++u) {
        color.at<cv::Vec3f>(v, u) *= std::max(0.1F, 1 + contrast * light.at<float>(v, u));
      }
    }
  }
  if (dice.chance(0.35)) {
    cv::GaussianBlur(color, color, {0, 0}, static_cast<double>(dice.uniform(0.4F, 1.6F)));
  }
  if (dice.chance(0.1)) {  // motion
    const int length = dice.integer(3, 7);
    blur_along(length, dice.uniform(0, kPi), color);
  }
  if (dice.chance(0.2)) {  // what a low resolution or strong compression leaves
    cv::Mat small;
    const double share = static_cast<double>(dice.uniform(0.35F, 0.7F));
    cv::resize(color, small, {}, share, share, cv::INTER_AREA);
    cv::resize(small, color, color.size(), 0, 0, cv::INTER_LINEAR);
  }
  if (dice.chance(0.6)) add_noise(color, dice.uniform(0, 0.06F), dice);
  color = cv::min(cv::max(color, 0), 1);
}

}  // namespace

void spoil_colors(const Targets& truth, const SpoilConfig& config, float pixel_px, Dice& dice,
                  cv::Mat& color) {
  dress_rope(truth, dice, color);
  dress_ground(truth, dice, color);
  spoil_color(config, dice, color);
  spoil_picture(config, pixel_px, dice, color);
}

}  // namespace flowdlo::strand
