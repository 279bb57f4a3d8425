// The C interface to masks: each function checks what it was given and calls the C++ one.
#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <vector>

#include "c_api/arguments.hpp"
#include "c_api/images.hpp"
#include "flowdlo/flowdlo.h"
#include "flowdlo/mask.hpp"

namespace flowdlo::c_api {
namespace {

/// Of a struct that has these fields.
template <class Struct>
MaskCleaning cleaning_of(const Struct& given) {
  return {given.smooth != 0, given.fill_holes_px2, given.least_piece_px2};
}

template <class Struct>
void put_cleaning(Struct& to) {
  const MaskCleaning defaults;
  to.smooth = defaults.smooth ? 1 : 0;
  to.fill_holes_px2 = defaults.fill_holes_px2;
  to.least_piece_px2 = defaults.least_piece_px2;
}

flowdlo_color_band default_color_band() {
  const ColorBand defaults;
  flowdlo_color_band band{};
  band.struct_size = sizeof(band);
  band.tolerance = defaults.tolerance;
  band.least_lightness = defaults.least_lightness;
  band.most_lightness = defaults.most_lightness;
  put_cleaning(band);
  return band;
}

flowdlo_height_band default_height_band() {
  const HeightBand defaults;
  flowdlo_height_band band{};
  band.struct_size = sizeof(band);
  band.least_m = defaults.least_m;
  band.most_m = defaults.most_m;
  put_cleaning(band);
  return band;
}

flowdlo_seed_growth default_seed_growth() {
  const SeedGrowth defaults;
  flowdlo_seed_growth growth{};
  growth.struct_size = sizeof(growth);
  growth.tolerance = defaults.tolerance;
  growth.lightness_tolerance = defaults.lightness_tolerance;
  growth.depth_step_m = defaults.depth_step_m;
  put_cleaning(growth);
  return growth;
}

/// What `given` says, or `defaults` where it is NULL and may be.
template <class Struct>
Result<Struct> read_or(const Struct* given, const Struct& defaults) {
  if (given == nullptr) return defaults;
  if (const auto fits = check_size(given); !fits) return fits.error();
  return read(given, defaults);
}

/// The mask that `make` makes of the frame, copied to the caller's bytes.
template <class Make>
Result<void> mask_of(const char* who, const flowdlo_frame* given, const Uses& uses,
                     std::uint8_t* to, std::size_t bytes, const Make& make) {
  if (const auto fits = check_size(given); !fits) return fits.error();
  if (const auto there = check_there(to, who); !there) return there.error();
  Copies copies;
  const auto frame = frame_of(read(given, default_frame()), copies, uses);
  if (!frame) return frame.error();
  const auto pixels =
      static_cast<std::size_t>(frame->width) * static_cast<std::size_t>(frame->height);
  if (bytes != pixels) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: mask_bytes: expected {} ({} x {}), got {}; give a byte for each "
                             "pixel of the region",
                             who, pixels, frame->width, frame->height, bytes)};
  }
  const Result<Mask> mask = make(*frame);
  if (!mask) return mask.error();
  std::memcpy(to, mask->data(), bytes);
  return {};
}

Result<void> from_color(const flowdlo_frame* frame, const flowdlo_color_band* given,
                        std::uint8_t* to, std::size_t bytes) {
  if (const auto fits = check_size(given); !fits) return fits.error();
  const flowdlo_color_band band = read(given, default_color_band());
  return mask_of(
      "flowdlo_mask_from_color", frame, {Use::kUnread, Use::kUnread, Use::kNeeded, Use::kUnread},
      to, bytes, [&](const Frame& of) {
        return mask_from_color(of, {band.red, band.green, band.blue, band.tolerance,
                                    band.least_lightness, band.most_lightness, cleaning_of(band)});
      });
}

Result<void> from_plane(const flowdlo_frame* frame, const flowdlo_height_band* given,
                        std::uint8_t* to, std::size_t bytes) {
  const auto band = read_or(given, default_height_band());
  if (!band) return band.error();
  if (band->reserved != 0) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_height_band.reserved: expected 0, got {}; fill the struct "
                             "with flowdlo_height_band_init before use",
                             band->reserved)};
  }
  return mask_of("flowdlo_mask_from_plane", frame,
                 {Use::kNeeded, Use::kUnread, Use::kUnread, Use::kUnread}, to, bytes,
                 [&](const Frame& of) {
                   return mask_from_plane(of, {band->least_m, band->most_m, cleaning_of(*band)});
                 });
}

Result<void> from_seeds(const flowdlo_frame* frame, const float* seeds, std::size_t count,
                        const flowdlo_seed_growth* given, std::uint8_t* to, std::size_t bytes) {
  if (const auto there = check_there(seeds, "flowdlo_mask_from_seeds: seeds"); !there) {
    return there.error();
  }
  if (count > kMostSeeds) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_mask_from_seeds: count: expected 1 to {}, got {}; pass fewer",
                             kMostSeeds, count)};
  }
  const auto growth = read_or(given, default_seed_growth());
  if (!growth) return growth.error();
  return mask_of("flowdlo_mask_from_seeds", frame,
                 {Use::kIfThere, Use::kUnread, Use::kNeeded, Use::kUnread}, to, bytes,
                 [&](const Frame& of) {
                   std::vector<Pixel> pixels;
                   for (std::size_t i = 0; i < count; ++i) {
                     pixels.push_back({seeds[2 * i] - static_cast<float>(frame->roi_u),
                                       seeds[2 * i + 1] - static_cast<float>(frame->roi_v)});
                   }
                   return mask_from_seeds(of, pixels,
                                          {growth->tolerance, growth->lightness_tolerance,
                                           growth->depth_step_m, cleaning_of(*growth)});
                 });
}

}  // namespace
}  // namespace flowdlo::c_api

namespace guard = flowdlo::guard;
namespace c_api = flowdlo::c_api;

flowdlo_status flowdlo_color_band_init(flowdlo_color_band* band, size_t struct_size) {
  return c_api::initialise(band, struct_size, c_api::default_color_band());
}

flowdlo_status flowdlo_height_band_init(flowdlo_height_band* band, size_t struct_size) {
  return c_api::initialise(band, struct_size, c_api::default_height_band());
}

flowdlo_status flowdlo_seed_growth_init(flowdlo_seed_growth* growth, size_t struct_size) {
  return c_api::initialise(growth, struct_size, c_api::default_seed_growth());
}

flowdlo_status flowdlo_mask_from_color(const flowdlo_frame* frame, const flowdlo_color_band* band,
                                       uint8_t* mask, size_t mask_bytes) {
  return c_api::told(guard::guarded(
      "flowdlo_mask_from_color", [&] { return c_api::from_color(frame, band, mask, mask_bytes); }));
}

flowdlo_status flowdlo_mask_from_plane(const flowdlo_frame* frame, const flowdlo_height_band* band,
                                       uint8_t* mask, size_t mask_bytes) {
  return c_api::told(guard::guarded(
      "flowdlo_mask_from_plane", [&] { return c_api::from_plane(frame, band, mask, mask_bytes); }));
}

flowdlo_status flowdlo_mask_from_seeds(const flowdlo_frame* frame, const float* seeds, size_t count,
                                       const flowdlo_seed_growth* growth, uint8_t* mask,
                                       size_t mask_bytes) {
  return c_api::told(guard::guarded("flowdlo_mask_from_seeds", [&] {
    return c_api::from_seeds(frame, seeds, count, growth, mask, mask_bytes);
  }));
}
