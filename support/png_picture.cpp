#include "png_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowdlo::support {
namespace {

std::uint8_t byte_of(std::uint8_t value) { return value; }
std::uint8_t byte_of(std::uint16_t value) {
  return static_cast<std::uint8_t>(std::min(std::lrint(value / 256.0), 255L));
}

template <class Value>
Color color_at(const Value* values, int channels) {
  if (channels == 1) return color_of(byte_of(values[0]));
  return {byte_of(values[0]), byte_of(values[1]), byte_of(values[2])};
}

template <class Value>
std::uint8_t grey_at(const Value* values, int channels) {
  return channels == 1 ? byte_of(values[0]) : grey_of(color_at(values, channels));
}

/// `pixel_at` says what a pixel becomes whose values begin there.
template <class Pixel, class Value, class PixelAt>
image::Image<Pixel> converted(const frame::PngImage& png, PixelAt pixel_at) {
  const frame::PngFormat& format = png.format();
  image::Image<Pixel> result({format.width, format.height});
  const Value* values = png.values<Value>().data();
  for (std::size_t i = 0; i < result.total(); ++i) {
    result.data()[i] = pixel_at(values, format.channels);
    values += format.channels;
  }
  return result;
}

Result<std::vector<std::uint8_t>> encoded(const image::Size& size, int channels, const void* first,
                                          std::ptrdiff_t stride_bytes) {
  return frame::encode_png({size.width, size.height, channels, 8}, first,
                           static_cast<std::size_t>(stride_bytes));
}

}  // namespace

Picture picture_of(const frame::PngImage& png) {
  return png.format().bits == 16 ? converted<Color, std::uint16_t>(png, color_at<std::uint16_t>)
                                 : converted<Color, std::uint8_t>(png, color_at<std::uint8_t>);
}

image::Image<std::uint8_t> grey_image_of(const frame::PngImage& png) {
  using Grey = std::uint8_t;
  return png.format().bits == 16 ? converted<Grey, std::uint16_t>(png, grey_at<std::uint16_t>)
                                 : converted<Grey, std::uint8_t>(png, grey_at<std::uint8_t>);
}

Result<std::vector<std::uint8_t>> encode_png(const ConstPicture& picture) {
  return encoded(picture.size(), 3, picture.data(), 3 * picture.stride());
}

Result<std::vector<std::uint8_t>> encode_png(const image::Image<const std::uint8_t>& grey) {
  return encoded(grey.size(), 1, grey.data(), grey.stride());
}

}  // namespace flowdlo::support
