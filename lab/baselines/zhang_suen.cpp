#include "baselines/zhang_suen.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flowdlo::baselines {
namespace {

// Neighbours clockwise from the north: P2, P3, ..., P9 of the paper.
std::array<int, 8> around(const cv::Mat& image, int v, int u) {
  const auto at = [&](int dv, int du) { return image.at<std::uint8_t>(v + dv, u + du) != 0; };
  return {at(-1, 0), at(-1, 1), at(0, 1), at(1, 1), at(1, 0), at(1, -1), at(0, -1), at(-1, -1)};
}

bool deletable(const std::array<int, 8>& p, bool second) {
  int count = 0;
  int rises = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    count += p[k];
    rises += p[k] == 0 && p[(k + 1) % p.size()] == 1 ? 1 : 0;
  }
  if (count < 2 || count > 6 || rises != 1) return false;
  const int north = p[0];
  const int east = p[2];
  const int south = p[4];
  const int west = p[6];
  if (second) return north * east * west == 0 && north * south * west == 0;
  return north * east * south == 0 && east * south * west == 0;
}

bool sweep(cv::Mat& image, bool second) {
  std::vector<std::uint8_t*> doomed;
  for (int v = 1; v + 1 < image.rows; ++v) {
    for (int u = 1; u + 1 < image.cols; ++u) {
      std::uint8_t& pixel = image.at<std::uint8_t>(v, u);
      if (pixel != 0 && deletable(around(image, v, u), second)) doomed.push_back(&pixel);
    }
  }
  for (std::uint8_t* pixel : doomed) *pixel = 0;
  return !doomed.empty();
}

// A pixel between two neighbours at a right angle that nothing else needs.
bool corner(const std::array<int, 8>& p) {
  bool turn = false;
  int pieces = 0;  // 8-connected pieces of the neighbourhood
  for (std::size_t k = 0; k < p.size(); k += 2) {
    const int diagonal = p[k + 1];
    const int next = p[(k + 2) % p.size()];
    turn = turn || (p[k] == 1 && next == 1);
    pieces += p[k] == 0 && (diagonal == 1 || next == 1) ? 1 : 0;
  }
  return turn && pieces == 1;
}

// The two passes leave staircases two pixels wide.
void thin_staircases(cv::Mat& image) {
  for (int v = 1; v + 1 < image.rows; ++v) {
    for (int u = 1; u + 1 < image.cols; ++u) {
      std::uint8_t& pixel = image.at<std::uint8_t>(v, u);
      if (pixel != 0 && corner(around(image, v, u))) pixel = 0;
    }
  }
}

}  // namespace

cv::Mat zhang_suen(const cv::Mat& mask) {
  cv::Mat image = (mask != 0);
  if (image.rows < 3 || image.cols < 3) return cv::Mat::zeros(mask.size(), CV_8U);
  image.row(0).setTo(0);
  image.row(image.rows - 1).setTo(0);
  image.col(0).setTo(0);
  image.col(image.cols - 1).setTo(0);
  bool changed = true;
  while (changed) {
    const bool first = sweep(image, false);
    const bool second = sweep(image, true);
    changed = first || second;
  }
  thin_staircases(image);
  return image;
}

}  // namespace flowdlo::baselines
