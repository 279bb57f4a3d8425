#include "path/strokes.hpp"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>
#include <utility>

#include "path/limits.hpp"

namespace flowdlo::path {
namespace {

constexpr int kFilters_px[] = {5, 13, 21};  // sides of the majority filters, the mildest first

cv::Mat majority(const cv::Mat& mask, int side_px) {
  cv::Mat share = mask * 255;
  cv::boxFilter(share, share, CV_8U, {side_px, side_px}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::Mat result = (share > 127) / 255;
  result.row(0).setTo(0);
  result.row(result.rows - 1).setTo(0);
  result.col(0).setTo(0);
  result.col(result.cols - 1).setTo(0);
  return result;
}

}  // namespace

std::int64_t stroke_length_px(const cv::Mat& mask) {
  std::int64_t border = 0;
  for (int v = 1; v + 1 < mask.rows; ++v) {
    const std::uint8_t* up = mask.ptr<std::uint8_t>(v - 1);
    const std::uint8_t* row = mask.ptr<std::uint8_t>(v);
    const std::uint8_t* down = mask.ptr<std::uint8_t>(v + 1);
    int here = 0;
    for (int u = 1; u + 1 < mask.cols; ++u) {
      here += row[u] & ((row[u - 1] & row[u + 1] & up[u] & down[u]) ^ 1);
    }
    border += here;
  }
  return border / 2;
}

Result<Strokes> strokes_of(cv::Mat mask, const cv::Size& image, int ropes) {
  const std::int64_t sides = image.width + image.height;
  const std::int64_t one = kMostStrokeSides * sides;
  const std::int64_t most = ropes == 1 ? one : kMostRopesSides * sides;
  const std::int64_t given = stroke_length_px(mask);
  if (given <= most) return Strokes{std::move(mask)};
  for (const int side_px : kFilters_px) {
    cv::Mat smooth = majority(mask, side_px);
    if (stroke_length_px(smooth) <= one) return Strokes{std::move(smooth), true};
  }
  return Error{
      ErrorCode::kNoPath,
      fmt::format("path: expected {}, strokes at most {} px long in an image of {} x "
                  "{}, got {} px of noise or texture; check the segmentation",
                  ropes == 1 ? "one rope" : "ropes", most, image.width, image.height, given)};
}

}  // namespace flowdlo::path
