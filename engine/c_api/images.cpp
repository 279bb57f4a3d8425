#include "c_api/images.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

#include "geometry/depth.hpp"

namespace flowdlo::c_api {
namespace {

constexpr int kMostSide_px = 65536;  ///< of whole images; keeps every offset within 64 bits
constexpr std::ptrdiff_t kMostPixelBytes = 1 << 16;
constexpr std::ptrdiff_t kMostRowBytes = std::ptrdiff_t{1} << 40;

struct Faults {
  std::string lines;

  void add(const std::string& line) { lines += (lines.empty() ? "" : "\n") + line; }
};

struct Rectangle {
  int u = 0;
  int v = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
};

std::ptrdiff_t size_of_pixel(std::int32_t pixel) {
  switch (pixel) {
    case FLOWDLO_PIXEL_F32:
      return sizeof(float);
    case FLOWDLO_PIXEL_U16:
      return sizeof(std::uint16_t);
    case FLOWDLO_PIXEL_U8:
      return 1;
    default:
      return 3;
  }
}

/// An image whose strides are said and were checked.
struct Strided {
  const std::byte* first = nullptr;  ///< pixel of the region's corner
  std::ptrdiff_t row_bytes = 0;
  std::ptrdiff_t pixel_bytes = 0;
  std::int32_t pixel = 0;

  [[nodiscard]] const std::byte* row(int v) const { return first + v * row_bytes; }

  [[nodiscard]] std::size_t alignment() const {
    if (pixel == FLOWDLO_PIXEL_F32) return alignof(float);
    return pixel == FLOWDLO_PIXEL_U16 ? alignof(std::uint16_t) : 1;
  }

  /// Pixels of the region follow each other, so that a view is enough.
  [[nodiscard]] bool packed(const Rectangle& region) const {
    return pixel_bytes == size_of_pixel(pixel) &&
           (region.height == 1 || row_bytes == pixel_bytes * region.width) &&
           reinterpret_cast<std::uintptr_t>(first) % alignment() == 0;
  }
};

Rectangle region_of(const flowdlo_frame& frame, Faults& faults) {
  const auto side = [&](const char* name, int px) {
    if (px >= 1 && px <= kMostSide_px) return;
    faults.add(fmt::format("flowdlo_frame.{}: expected 1 to {} px, got {}; give the images' size",
                           name, kMostSide_px, px));
  };
  side("width", frame.width);
  side("height", frame.height);
  if (!faults.lines.empty()) return {};
  if (frame.roi_width == 0 && frame.roi_height == 0 && frame.roi_u == 0 && frame.roi_v == 0) {
    return {0, 0, frame.width, frame.height};
  }
  const Rectangle region{frame.roi_u, frame.roi_v, frame.roi_width, frame.roi_height};
  const auto inside = [](int first, int count, int of) {
    return first >= 0 && count >= 1 && first < of && count <= of - first;
  };
  if (!inside(region.u, region.width, frame.width) ||
      !inside(region.v, region.height, frame.height)) {
    faults.add(
        fmt::format("flowdlo_frame.roi: expected a region within {} x {} px, got {} x {} px at "
                    "({}, {}); leave all four at 0 for the whole images",
                    frame.width, frame.height, region.width, region.height, region.u, region.v));
  }
  return region;
}

/// `image` from the region's corner on; faults where its kind or strides are none that it may have.
Strided strided(const char* name, const flowdlo_image& image, std::int32_t one, std::int32_t other,
                const char* expected, const flowdlo_frame& frame, const Rectangle& region,
                Faults& faults) {
  const auto fault = [&](const std::string& line) {
    faults.add(fmt::format("flowdlo_frame.{}.{}", name, line));
    return Strided{};
  };
  if (image.data == nullptr) return fault("data: expected an image, got NULL; pass its pixels");
  if (image.pixel != one && image.pixel != other) {
    return fault(fmt::format("pixel: expected {}, got {}", expected, image.pixel));
  }
  if (image.reserved != 0) {
    return fault(
        fmt::format("reserved: expected 0, got {}; fill the image with 0", image.reserved));
  }
  const auto size = size_of_pixel(image.pixel);
  const auto pixel_bytes = image.pixel_bytes == 0 ? size : image.pixel_bytes;
  if (pixel_bytes > kMostPixelBytes || pixel_bytes < -kMostPixelBytes ||
      std::abs(pixel_bytes) < size) {
    return fault(
        fmt::format("pixel_bytes: expected {} to {} bytes from a pixel to the next, got {}; 0 says "
                    "that pixels follow each other",
                    size, kMostPixelBytes, pixel_bytes));
  }
  const auto row_size = std::abs(pixel_bytes) * (frame.width - 1) + size;
  const auto row_bytes = image.row_bytes == 0 ? pixel_bytes * frame.width : image.row_bytes;
  if (row_bytes > kMostRowBytes || row_bytes < -kMostRowBytes || std::abs(row_bytes) < row_size) {
    return fault(
        fmt::format("row_bytes: expected at least the {} bytes of a row, got {}; it counts bytes, "
                    "not pixels, and 0 says that rows follow each other",
                    row_size, row_bytes));
  }
  const auto corner = region.v * row_bytes + region.u * pixel_bytes;
  return {static_cast<const std::byte*>(image.data) + corner, row_bytes, pixel_bytes, image.pixel};
}

/// `at(source, target)` of every pixel of the region, in order.
template <class At>
void for_each_pixel(const Strided& image, const Rectangle& region, const At& at) {
  std::size_t pixel = 0;
  for (int v = 0; v < region.height; ++v) {
    const std::byte* source = image.row(v);
    for (int u = 0; u < region.width; ++u, source += image.pixel_bytes) at(source, pixel++);
  }
}

/// Of an image whose pixels are such values: a view where they are packed, else a copy.
template <class Value>
std::span<const Value> values_of(const Strided& image, const Rectangle& region,
                                 std::vector<Value>& copy) {
  if (image.packed(region)) {
    return {reinterpret_cast<const Value*>(image.first), region.pixels()};
  }
  copy.resize(region.pixels());
  for_each_pixel(image, region, [&](const std::byte* source, std::size_t pixel) {
    std::memcpy(&copy[pixel], source, sizeof(Value));
  });
  return copy;
}

std::span<const float> depth_of(const Strided& image, const Rectangle& region, double scale_m,
                                std::vector<float>& copy) {
  if (image.pixel == FLOWDLO_PIXEL_F32) return values_of(image, region, copy);
  copy.resize(region.pixels());
  for_each_pixel(image, region, [&](const std::byte* source, std::size_t pixel) {
    std::uint16_t units = 0;
    std::memcpy(&units, source, sizeof(units));
    copy[pixel] = geometry::metres(units, scale_m);
  });
  return copy;
}

std::span<const std::uint8_t> color_of(const Strided& image, const Rectangle& region,
                                       std::vector<std::uint8_t>& copy) {
  if (image.pixel == FLOWDLO_PIXEL_BGR8 && image.packed(region)) {
    return {reinterpret_cast<const std::uint8_t*>(image.first), region.pixels() * 3};
  }
  copy.resize(region.pixels() * 3);
  const std::size_t blue = image.pixel == FLOWDLO_PIXEL_BGR8 ? 0 : 2;
  for_each_pixel(image, region, [&](const std::byte* source, std::size_t pixel) {
    copy[3 * pixel] = static_cast<std::uint8_t>(source[blue]);
    copy[3 * pixel + 1] = static_cast<std::uint8_t>(source[1]);
    copy[3 * pixel + 2] = static_cast<std::uint8_t>(source[2 - blue]);
  });
  return copy;
}

}  // namespace

flowdlo_frame default_frame() {
  flowdlo_frame frame{};
  frame.struct_size = sizeof(frame);
  frame.depth_scale_m = 0.001;
  return frame;
}

Result<Frame> frame_of(const flowdlo_frame& given, Copies& copies, const Uses& uses) {
  Faults faults;
  const Rectangle region = region_of(given, faults);
  if (!faults.lines.empty()) return Error{ErrorCode::kBadInput, faults.lines};
  const auto read = [&](const char* name, const flowdlo_image& image, Use use, std::int32_t one,
                        std::int32_t other, const char* expected) {
    const bool absent = image.data == nullptr && use == Use::kIfThere;
    if (absent || use == Use::kUnread) return Strided{};
    return strided(name, image, one, other, expected, given, region, faults);
  };
  const Strided depth = read("depth", given.depth, uses.depth, FLOWDLO_PIXEL_F32, FLOWDLO_PIXEL_U16,
                             "FLOWDLO_PIXEL_F32 or FLOWDLO_PIXEL_U16");
  const Strided mask =
      read("mask", given.mask, uses.mask, FLOWDLO_PIXEL_U8, FLOWDLO_PIXEL_U8, "FLOWDLO_PIXEL_U8");
  const Strided color = read("color", given.color, uses.color, FLOWDLO_PIXEL_BGR8,
                             FLOWDLO_PIXEL_RGB8, "FLOWDLO_PIXEL_BGR8 or FLOWDLO_PIXEL_RGB8");
  const Strided instances = read("instances", given.instances, uses.instances, FLOWDLO_PIXEL_U16,
                                 FLOWDLO_PIXEL_U16, "FLOWDLO_PIXEL_U16");
  if (uses.depth != Use::kUnread && given.depth.pixel == FLOWDLO_PIXEL_U16 &&
      !(given.depth_scale_m > 0 && given.depth_scale_m <= 1)) {
    faults.add(fmt::format(
        "flowdlo_frame.depth_scale_m: expected metres a unit, over 0 and at most 1, got {}; "
        "a depth in millimetres has 0.001",
        given.depth_scale_m));
  }
  if (!faults.lines.empty()) return Error{ErrorCode::kBadInput, faults.lines};

  Frame frame{.width = region.width,
              .height = region.height,
              .intrinsics = {given.fx, given.fy, given.cx - static_cast<float>(region.u),
                             given.cy - static_cast<float>(region.v)},
              .depth_m = {},
              .mask = {},
              .color_bgr = {},
              .instances = {}};
  if (depth.first != nullptr) {
    frame.depth_m = depth_of(depth, region, given.depth_scale_m, copies.depth_m);
  }
  if (mask.first != nullptr) frame.mask = values_of(mask, region, copies.mask);
  if (color.first != nullptr) frame.color_bgr = color_of(color, region, copies.color_bgr);
  if (instances.first != nullptr) frame.instances = values_of(instances, region, copies.instances);
  return frame;
}

}  // namespace flowdlo::c_api
