// PNG images in memory, by libpng.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// Rows without padding; 1, 3 (BGR) or 4 (BGRA) channels of 8 or 16 bits, in this machine's byte
/// order.
struct PngFormat {
  int width = 0;
  int height = 0;
  int channels = 1;
  int bits = 8;

  [[nodiscard]] std::size_t values() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(channels);
  }
  friend bool operator==(const PngFormat&, const PngFormat&) = default;
};

/// An image of any such format; empty: none.
class PngImage {
 public:
  PngImage() = default;
  /// Values that nobody has set yet. Throws std::bad_alloc.
  explicit PngImage(const PngFormat& format)
      : format_(format),
        bytes_(std::make_shared_for_overwrite<std::byte[]>(format.values() * format.bits / 8)) {}

  [[nodiscard]] const PngFormat& format() const { return format_; }
  [[nodiscard]] bool empty() const { return bytes_ == nullptr; }

  /// All values; `Value` is as wide as they are: std::uint8_t or std::uint16_t.
  template <class Value>
  [[nodiscard]] std::span<Value> values() {
    return {reinterpret_cast<Value*>(bytes_.get()), empty() ? 0 : format_.values()};
  }
  template <class Value>
  [[nodiscard]] std::span<const Value> values() const {
    return {reinterpret_cast<const Value*>(bytes_.get()), empty() ? 0 : format_.values()};
  }

 private:
  PngFormat format_;
  std::shared_ptr<std::byte[]> bytes_;
};

/// The image as stored, at most kMaxSide_px a side. Fails with kBadInput when `bytes` is no whole
/// PNG; the message begins with `who`, the file's name.
[[nodiscard]] Result<PngImage> decode_png(std::span<const std::uint8_t> bytes,
                                          const std::string& who);

/// `first`: the first value; `stride_bytes`: from one row to the next. Fails with kInternal.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const PngFormat& format,
                                                           const void* first,
                                                           std::size_t stride_bytes);

}  // namespace flowdlo::frame
