#include "strand/mask_faults.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "strand/noise.hpp"

namespace flowdlo::strand {
namespace {

constexpr double kLeastMasked = 0.5;  // share of a mask that missing stretches leave

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

}  // namespace

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

}  // namespace flowdlo::strand
