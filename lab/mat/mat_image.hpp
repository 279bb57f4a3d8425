// MatImage: OpenCV's images as those of engine/image, and back.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>

#include "image/image.hpp"

namespace flowdlo::mat {

template <class T>
struct Kind {
  static constexpr int kType = cv::DataType<T>::type;
};
template <class T, std::size_t kChannels>
struct Kind<std::array<T, kChannels>> {
  static constexpr int kType = CV_MAKETYPE(cv::DataType<T>::depth, static_cast<int>(kChannels));
};

inline image::Size size_of(const cv::Size& size) { return {size.width, size.height}; }
inline image::Point point_of(const cv::Point& p) { return {p.x, p.y}; }
inline cv::Size size_of(const image::Size& size) { return {size.width, size.height}; }
inline cv::Point point_of(const image::Point& p) { return {p.x, p.y}; }

/// The same pixels, which it keeps. `mat` has that type.
template <class T>
[[nodiscard]] image::Image<T> image_of(const cv::Mat& mat) {
  if (mat.empty()) return {};
  CV_Assert(mat.type() == Kind<T>::kType);
  auto kept = std::make_shared<cv::Mat>(mat);
  auto* const first = reinterpret_cast<T*>(kept->data);
  const auto stride = static_cast<std::ptrdiff_t>(kept->step[0] / sizeof(T));
  return {first, {mat.cols, mat.rows}, stride, std::move(kept)};
}

/// The same pixels, which `given` has to keep. Whoever gets it only reads them where they are
/// const.
template <class T>
[[nodiscard]] cv::Mat mat_over(const image::Image<T>& given) {
  if (given.empty()) return {};
  using Plain = std::remove_const_t<T>;
  return {given.height(), given.width(), Kind<Plain>::kType, const_cast<Plain*>(given.data()),
          static_cast<std::size_t>(given.stride()) * sizeof(T)};
}

/// A copy.
template <class T>
[[nodiscard]] cv::Mat mat_of(const image::Image<T>& given) {
  return mat_over(given).clone();
}

}  // namespace flowdlo::mat
