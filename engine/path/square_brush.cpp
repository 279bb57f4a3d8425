// A square is a row of columns: both directions are done one after the other. In each, a pixel
// keeps its place while a run of equal pixels reaches `half` beyond it on both sides, and runs are
// counted on the way.
#include "path/square_brush.hpp"

#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace flowdlo::path {
namespace {

constexpr int kSmall =
    16;  // half sizes up to which OpenCV's brushes, a pixel at a time, are faster

cv::Mat brush(int half) { return cv::Mat::ones(2 * half + 1, 2 * half + 1, CV_8U); }

// Whether the pixel is `wanted`, the value that a run is made of.
int counted(int run, std::uint8_t pixel, std::uint8_t wanted) {
  return (pixel != 0) == (wanted != 0) ? run + 1 : 0;
}

// [h, w] 1 where all of 2 `half` + 1 pixels along the row are `wanted`; empty ones lie outside.
cv::Mat along_rows(const cv::Mat& mask, int half, std::uint8_t wanted) {
  cv::Mat kept(mask.size(), CV_8U);
  for (int v = 0; v < mask.rows; ++v) {
    const std::uint8_t* from = mask.ptr<std::uint8_t>(v);
    std::uint8_t* to = kept.ptr<std::uint8_t>(v);
    int run = wanted == 0 ? half : 0;
    for (int u = 0; u < mask.cols + half; ++u) {
      run = counted(run, u < mask.cols ? from[u] : std::uint8_t{0}, wanted);
      if (u >= half) to[u - half] = run > 2 * half ? 1 : 0;
    }
  }
  return kept;
}

// The same along columns of `mask`, in which `wanted` is 1; `outside` lies around it.
cv::Mat along_columns(const cv::Mat& mask, int half, std::uint8_t outside) {
  cv::Mat kept(mask.size(), CV_8U);
  std::vector<int> runs(static_cast<std::size_t>(mask.cols), outside != 0 ? half : 0);
  const cv::Mat beyond(1, mask.cols, CV_8U, cv::Scalar(outside));
  for (int v = 0; v < mask.rows + half; ++v) {
    const std::uint8_t* from =
        v < mask.rows ? mask.ptr<std::uint8_t>(v) : beyond.ptr<std::uint8_t>(0);
    std::uint8_t* to = v >= half ? kept.ptr<std::uint8_t>(v - half) : nullptr;
    for (int u = 0; u < mask.cols; ++u) {
      int& run = runs[static_cast<std::size_t>(u)];
      run = counted(run, from[u], 1);
      if (to != nullptr) to[u] = run > 2 * half ? 1 : 0;
    }
  }
  return kept;
}

}  // namespace

cv::Mat eroded(const cv::Mat& mask, int half) {
  if (half > kSmall) return along_columns(along_rows(mask, half, 1), half, 0);
  cv::Mat result;
  cv::erode(mask, result, brush(half), {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  return result;
}

cv::Mat dilated(const cv::Mat& mask, int half) {
  if (half > kSmall) return 1 - along_columns(along_rows(mask, half, 0), half, 1);
  cv::Mat result;
  cv::dilate(mask, result, brush(half));
  return result;
}

}  // namespace flowdlo::path
