#include "strand/sample.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "mat/mat_image.hpp"
#include "strand/targets.hpp"

namespace flowdlo::strand {
namespace {

constexpr double kLeastMasked = 0.5;  // share of a mask that missing stretches leave
constexpr float kDense_px = 0.5F;     // between points of a strand in a sample
constexpr float kPi = std::numbers::pi_v<float>;

class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t number)
      : random_(seed * 0xD1342543DE82EF95ULL + number * 0x9E3779B97F4A7C15ULL + 1) {}

  float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(static_cast<double>(random_() >> 11U) * 0x1p-53);
  }
  float gaussian() {
    const float radius = std::sqrt(-2 * std::log(std::max(uniform(0, 1), 1e-9F)));
    return radius * std::cos(uniform(0, 2 * kPi));
  }
  bool chance(double share) { return static_cast<double>(uniform(0, 1)) < share; }
  int integer(int low, int high) {  // both included
    const auto count = static_cast<std::uint64_t>(high - low + 1);
    return low + static_cast<int>(random_() % count);
  }
  /// Logarithms evenly spread.
  float factor(float low, float high) { return std::exp(uniform(std::log(low), std::log(high))); }
  std::uint64_t word() { return random_(); }

 private:
  std::mt19937_64 random_;
};

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

/// One of both ends of the image's diagonal to the other: smooth noise of deviation about 1.
cv::Mat smooth_noise(int size_px, double cell_px, Dice& dice) {
  const int cells = std::max(2, static_cast<int>(size_px / cell_px));
  cv::Mat coarse(cells, cells, CV_32F);
  for (int i = 0; i < cells * cells; ++i) coarse.ptr<float>()[i] = dice.gaussian();
  cv::Mat fine;
  cv::resize(coarse, fine, {size_px, size_px}, 0, 0, cv::INTER_CUBIC);
  return fine;
}

void add_noise(cv::Mat& image, float deviation, Dice& dice) {
  cv::RNG random(dice.word());
  cv::Mat noise(image.size(), image.type());
  random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0),
              cv::Scalar::all(static_cast<double>(deviation)));
  image += noise;
}

/// Noise of a camera whose pixels are `pixel_px` wide here, in levels of 255.
void add_camera_noise(cv::Mat& image, float levels, float pixel_px, Dice& dice) {
  const int side =
      std::max(2, static_cast<int>(static_cast<float>(image.cols) / std::max(1.0F, pixel_px)));
  cv::Mat coarse = cv::Mat::zeros(side, side, image.type());
  add_noise(coarse, levels / 255, dice);
  cv::Mat fine;
  cv::resize(coarse, fine, image.size(), 0, 0, cv::INTER_LINEAR);
  image += fine;
}

// -- Masks --------------------------------------------------------------------------------------

void grow(cv::Mat& mask, int size) {
  cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
}

/// Takes the mask off a stretch of a strand.
void erase(const Strand& strand, std::size_t first, std::size_t last, cv::Mat& mask) {
  for (std::size_t i = first; i < last; ++i) {
    const AxisPoint& p = strand.points[i];
    if (p.seen != Seen::kYes) continue;
    cv::circle(mask,
               cv::Point(static_cast<int>(std::lround(p.u)), static_cast<int>(std::lround(p.v))),
               static_cast<int>(std::lround(1.2F * p.radius_px + 0.5F)), cv::Scalar(0), -1);
  }
}

/// Points of a strand within that many widths of arclength.
std::size_t points_in(const Strand& strand, float widths) {
  if (strand.points.size() < 2) return 0;
  const float all =
      std::abs(strand.points.back().along_widths - strand.points.front().along_widths);
  const float share = std::min(1.0F, widths / std::max(all, 1e-3F));
  return static_cast<std::size_t>(share * static_cast<float>(strand.points.size() - 1));
}

void cut_tips(const std::vector<Strand>& strands, Dice& dice, cv::Mat& mask) {
  for (const Strand& strand : strands) {
    const std::size_t count = points_in(strand, dice.factor(0.7F, 12));
    if (strand.begins && dice.chance(0.6)) erase(strand, 0, count, mask);
    if (strand.ends && dice.chance(0.6)) {
      erase(strand, strand.points.size() - count, strand.points.size(), mask);
    }
  }
}

void cut_gaps(const std::vector<Strand>& strands, Dice& dice, cv::Mat& mask) {
  for (int k = dice.integer(1, 3); k > 0 && !strands.empty(); --k) {
    const Strand& strand =
        strands[static_cast<std::size_t>(dice.integer(0, static_cast<int>(strands.size()) - 1))];
    const std::size_t count = points_in(strand, dice.factor(0.4F, 10));
    if (count + 1 >= strand.points.size()) continue;
    const auto first = static_cast<std::size_t>(
        dice.integer(0, static_cast<int>(strand.points.size() - count) - 1));
    erase(strand, first, first + count, mask);
  }
}

/// Returns what was taken off strands; empty: nothing.
cv::Mat spoil_mask(const std::vector<Strand>& strands, Dice& dice, cv::Mat& mask) {
  cv::Mat taken;
  const float how = dice.uniform(0, 1);
  if (how < 0.12F) {
    grow(mask, 3);
  } else if (how < 0.2F) {
    grow(mask, 5);
  } else if (how < 0.26F) {
    cv::erode(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {3, 3}));
  } else if (how < 0.42F) {  // what lies side by side becomes one
    const int size = dice.integer(2, 5) * 2 - 1;
    cv::morphologyEx(mask, mask, cv::MORPH_CLOSE,
                     cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  }
  if (dice.chance(0.1)) {
    const cv::Matx23f shift(1, 0, dice.uniform(-2, 2), 0, 1, dice.uniform(-2, 2));
    cv::warpAffine(mask, mask, shift, mask.size());
  }
  const bool tips = dice.chance(0.25);
  const bool gaps = dice.chance(0.2);
  if (tips || gaps) {
    const cv::Mat before = mask.clone();
    if (tips) cut_tips(strands, dice, mask);
    if (gaps) cut_gaps(strands, dice, mask);
    // A rope of which nothing is masked is one of the cables that are not meant.
    if (cv::sum(mask)[0] < kLeastMasked * cv::sum(before)[0]) mask = before;
    taken = before - mask;
  }
  if (dice.chance(0.1)) {  // frayed
    const cv::Mat noise = smooth_noise(mask.cols, static_cast<double>(dice.uniform(3, 9)), dice);
    cv::Mat blurred;
    cv::GaussianBlur(mask, blurred, {0, 0}, 1.2);
    cv::Mat frayed = blurred + 0.2 * noise;
    cv::threshold(frayed, mask, 0.5, 1, cv::THRESH_BINARY);
  }
  if (dice.chance(0.1)) {
    for (int k = dice.integer(1, 6); k > 0; --k) {
      cv::circle(mask, {dice.integer(0, mask.cols), dice.integer(0, mask.rows)}, dice.integer(1, 5),
                 cv::Scalar(dice.chance(0.6) ? 1 : 0), -1);
    }
  }
  if (dice.chance(0.5)) cv::threshold(mask, mask, 0.5, 1, cv::THRESH_BINARY);
  return taken;
}

// -- Colours ------------------------------------------------------------------------------------

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

// -- Depths -------------------------------------------------------------------------------------

/// The mean of what is known within `reach_px`, where anything is; elsewhere 0.
cv::Mat smooth_where_known(const cv::Mat& depth, double reach_px) {
  cv::Mat known;
  cv::threshold(depth, known, 0, 1, cv::THRESH_BINARY);
  cv::Mat weight;
  cv::Mat sum;
  cv::GaussianBlur(known, weight, {0, 0}, reach_px);
  cv::GaussianBlur(depth, sum, {0, 0}, reach_px);
  return sum / cv::max(weight, 1e-3);
}

void spoil_depth(Dice& dice, Scene& sight) {
  cv::Mat& depth = sight.depth_m;
  const cv::Mat none = depth <= 0;
  const cv::Scalar mean = cv::mean(depth, depth > 0);
  const auto width_m = static_cast<float>(field::kRope_px * mean[0]) / sight.focal_px;
  if (dice.chance(0.3)) {  // windows of a matcher: thin things sink into what is behind
    const cv::Mat smooth = smooth_where_known(depth, static_cast<double>(dice.uniform(0.6F, 3)));
    const double share = static_cast<double>(dice.uniform(0.3F, 1));
    depth = (1 - share) * depth + share * smooth;
  }
  if (dice.chance(0.4)) {
    const float deviation = dice.uniform(0, 0.3F) * width_m;
    if (dice.chance(0.5)) {
      cv::Mat noise = smooth_noise(depth.cols, static_cast<double>(dice.uniform(2, 6)), dice);
      depth += static_cast<double>(2 * deviation) * noise;
    } else {
      add_noise(depth, deviation, dice);
    }
  }
  depth += static_cast<double>(dice.uniform(-0.2F, 0.2F) * width_m);
  if (dice.chance(0.3)) {  // steps of the sensor
    const float step = dice.uniform(0.02F, 0.5F) * std::max(width_m, 1e-4F);
    for (int i = 0; i < depth.rows * depth.cols; ++i) {
      float& z = depth.ptr<float>()[i];
      z = std::round(z / step) * step;
    }
  }
  depth.setTo(0, none);
  for (int k = dice.chance(0.4) ? dice.integer(1, 2) : 0; k > 0; --k) {
    cv::ellipse(depth, {dice.integer(0, depth.cols), dice.integer(0, depth.rows)},
                {dice.integer(2, 30), dice.integer(2, 16)},
                static_cast<double>(dice.uniform(0, 180)), 0, 360, cv::Scalar(0), -1);
  }
  if (dice.chance(0.1)) {
    const auto share = static_cast<double>(dice.uniform(0.1F, 0.7F));
    for (int i = 0; i < depth.rows * depth.cols; ++i) {
      if (dice.chance(share)) depth.ptr<float>()[i] = 0;
    }
  }
  depth = cv::max(depth, 0);
}

/// As those have it who cut the rope out first: no depth around it, and often a ribbon's.
void keep_depth_of_mask(Dice& dice, Scene& sight) {
  sight.depth_m.setTo(0, sight.mask < 0.5);
  if (dice.chance(0.5)) return;
  const cv::Mat none = sight.depth_m <= 0;
  const double reach_px = static_cast<double>(dice.uniform(0.5F, 1.5F)) * field::kRope_px;
  sight.depth_m = smooth_where_known(sight.depth_m, reach_px);
  sight.depth_m.setTo(0, none);
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
    dress_rope(truth, dice, sight.color);
    dress_ground(truth, dice, sight.color);
    spoil_color(config, dice, sight.color);
    spoil_picture(config, patch.frame_scale * placing.scale, dice, sight.color);
  }
  bool beside = !sight.color.empty();  // whether anything shows beside the mask
  if (alone || dice.chance(config.no_depth)) {
    sight.depth_m.setTo(0);
  } else if (config.level > 0 && dice.chance(config.level)) {
    sight.depth_m.setTo(cv::mean(sight.depth_m, sight.depth_m > 0));
  } else if (config.mask_depth > 0 && dice.chance(config.mask_depth)) {
    spoil_depth(dice, sight);
    keep_depth_of_mask(dice, sight);
  } else {
    spoil_depth(dice, sight);
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
