// PNG: an error, or an image that is written and read again without loss.
#include "frame/png.hpp"

#include <cstring>

#include "png_file.hpp"
#include "promise.hpp"
#include "target.hpp"

using flowdlo::fuzz::promise;
namespace frame = flowdlo::frame;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  if (flowdlo::fuzz::is_large_png(bytes)) return 0;
  const auto image = frame::decode_png(bytes, "a.png");
  if (!image) {
    promise(image.error().message.starts_with("a.png: "), "an error names its file");
    return 0;
  }
  const frame::PngFormat& format = image->format();
  const auto values = image->values<std::uint8_t>();  // or the first half of their bytes
  const std::size_t stride = format.values() / format.height * format.bits / 8;
  const auto written = frame::encode_png(format, values.data(), stride);
  promise(written.has_value(), "an image that was read can be written");
  const auto again = frame::decode_png(*written, "again");
  promise(again.has_value(), "an image that was written can be read");
  promise(again->format() == format, "its kind stays");
  promise(
      std::memcmp(again->values<std::uint8_t>().data(), values.data(), stride * format.height) == 0,
      "its pixels stay");
  return 0;
}
