// Every way to a mask, on small frames: an error, or what mask.hpp promises. The first byte chooses
// the way; its numbers follow, any bits whatever or sensible ones, then colours, and then the
// frame.
#include <cmath>

#include "drawn_frame.hpp"
#include "flowdlo/mask.hpp"
#include "promise.hpp"
#include "target.hpp"

namespace {

using flowdlo::ErrorCode;
using flowdlo::Frame;
using flowdlo::Mask;
using flowdlo::MaskCleaning;
using flowdlo::Pixel;
using flowdlo::Plane;
using flowdlo::Result;
using flowdlo::fuzz::ByteSource;
using flowdlo::fuzz::DrawnFrame;
using flowdlo::fuzz::promise;

constexpr int kMostSide_px = 40;  // so that a fit takes milliseconds
constexpr int kColors = 4;        // of a drawn frame

/// A number of a call: 0 to 2.55 times `unit`, or any bits whatever.
float number(ByteSource& bytes, bool any, float unit) {
  return any ? bytes.number<float>() : unit * static_cast<float>(bytes.byte()) / 100;
}

MaskCleaning cleaning_of(ByteSource& bytes, bool any) {
  const bool smooth = bytes.byte() % 2 != 0;
  const float holes_px2 = number(bytes, any, 400);
  const float pieces_px2 = number(bytes, any, 400);
  return {smooth, holes_px2, pieces_px2};
}

/// One of a few colours for each pixel, by whether it is on the mask and by its column.
std::vector<std::uint8_t> painted(const std::vector<std::uint8_t>& colors,
                                  const DrawnFrame& frame) {
  std::vector<std::uint8_t> bgr;
  for (std::size_t pixel = 0; pixel < frame.mask.size(); ++pixel) {
    const auto column = pixel % static_cast<std::size_t>(frame.width);
    const std::size_t color = (frame.mask[pixel] != 0 ? 2 : 0) + column / 5 % 2;
    for (std::size_t channel = 0; channel < 3; ++channel)
      bgr.push_back(colors[3 * color + channel]);
  }
  return bgr;
}

void check_error(const flowdlo::Error& error) {
  promise(error.code == ErrorCode::kBadInput && !error.message.empty(), "a fault is named");
}

void check(const Result<Mask>& mask, std::size_t pixels) {
  if (!mask) return check_error(mask.error());
  promise(mask->size() == pixels, "a mask has the image's size");
  for (const std::uint8_t value : *mask) promise(value == 0 || value == 255, "a mask is 0 or 255");
}

void check(const Result<Plane>& plane) {
  if (!plane) return check_error(plane.error());
  const auto& [x, y, z] = plane->normal;
  promise(std::abs(std::hypot(x, y, z) - 1) < 1e-4F, "a normal has unit length");
  promise(std::isfinite(plane->distance_m) && plane->distance_m > 0, "a plane is somewhere");
  promise(std::isfinite(plane->noise_m) && plane->noise_m >= 0, "noise is a number");
  promise(plane->share > 0 && plane->share <= 1, "a share is in (0, 1]");
}

Result<Mask> made(int way, ByteSource numbers, const Frame& frame) {
  const bool any = way >= 128;
  if (way % 4 == 0) {
    flowdlo::ColorBand band;
    band.red = numbers.number<std::uint8_t>();
    band.green = numbers.number<std::uint8_t>();
    band.blue = numbers.number<std::uint8_t>();
    band.tolerance = number(numbers, any, 0.5F);
    band.least_lightness = number(numbers, any, 0.5F);
    band.most_lightness = number(numbers, any, 1);
    band.cleaning = cleaning_of(numbers, any);
    return mask_from_color(frame, band);
  }
  if (way % 4 == 1) {
    flowdlo::HeightBand band;
    band.least_m = number(numbers, any, 0.02F);
    band.most_m = number(numbers, any, 0.2F);
    band.cleaning = cleaning_of(numbers, any);
    return mask_from_plane(frame, band);
  }
  if (way % 4 == 2) {
    std::vector<Pixel> seeds(static_cast<std::size_t>(way / 4 % 8));
    for (Pixel& seed : seeds) {
      seed.u = number(numbers, any, static_cast<float>(frame.width) / 3);
      seed.v = number(numbers, any, static_cast<float>(frame.height) / 3);
    }
    flowdlo::SeedGrowth growth;
    growth.tolerance = number(numbers, any, 0.5F);
    growth.lightness_tolerance = number(numbers, any, 0.5F);
    growth.depth_step_m = number(numbers, any, 0.1F);
    growth.cleaning = cleaning_of(numbers, any);
    return mask_from_seeds(frame, seeds, growth);
  }
  return clean_mask(frame.width, frame.height, frame.mask, cleaning_of(numbers, any));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kNumbers = 48;  // bytes, as many as any way takes but for many seeds
  ByteSource bytes({data, size});
  const int way = bytes.byte();
  const ByteSource numbers(bytes.rest().first(std::min(bytes.rest().size(), kNumbers)));
  for (std::size_t i = 0; i < kNumbers; ++i) (void)bytes.byte();
  std::vector<std::uint8_t> colors;
  for (int i = 0; i < 3 * kColors; ++i) colors.push_back(bytes.number<std::uint8_t>());
  const DrawnFrame drawn = flowdlo::fuzz::draw_frame(bytes, kMostSide_px);
  const auto bgr = painted(colors, drawn);
  Frame frame = drawn.frame();
  frame.color_bgr = bgr;
  const auto mask = made(way, numbers, frame);
  check(mask, drawn.mask.size());
  if (way % 4 == 1) {
    check(flowdlo::fit_plane(frame));
  } else {
    const auto again = made(way, numbers, frame);
    promise(mask.has_value() == again.has_value() && (!mask || *mask == *again),
            "the same frame gives the same bits");
  }
  return 0;
}
