// Sized: structs that begin with struct_size and get more fields at their end in later versions.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <string>

#include "flowdlo/flowdlo.h"
#include "flowdlo/result.hpp"
#include "flowdlo/version.hpp"

namespace flowdlo::c_api {

/// What a struct is called and how large it was in the first version that had it. A later version
/// adds fields and leaves `kFirstBytes` alone; no struct has been of more than two sizes so far. No
/// byte of padding ends a struct, for a field that took its place would not change the size.
template <class Struct>
struct Kind;

template <>
struct Kind<flowdlo_config> {
  static constexpr const char* kName = "flowdlo_config";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_config, ropes) + sizeof(flowdlo_config::ropes);
  static_assert(sizeof(flowdlo_config) ==
                offsetof(flowdlo_config, reserved_2) + sizeof(flowdlo_config::reserved_2));
};

template <>
struct Kind<flowdlo_frame> {
  static constexpr const char* kName = "flowdlo_frame";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_frame, roi_height) + sizeof(flowdlo_frame::roi_height);
  static_assert(sizeof(flowdlo_frame) ==
                offsetof(flowdlo_frame, instances) + sizeof(flowdlo_frame::instances));
};

template <>
struct Kind<flowdlo_estimate> {
  static constexpr const char* kName = "flowdlo_estimate";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_estimate, reserved) + sizeof(flowdlo_estimate::reserved);
  static_assert(sizeof(flowdlo_estimate) == kFirstBytes);
};

template <>
struct Kind<flowdlo_alternative> {
  static constexpr const char* kName = "flowdlo_alternative";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_alternative, mask_agreement) + sizeof(flowdlo_alternative::mask_agreement);
  static_assert(sizeof(flowdlo_alternative) == kFirstBytes);
};

template <>
struct Kind<flowdlo_color_band> {
  static constexpr const char* kName = "flowdlo_color_band";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_color_band, least_piece_px2) + sizeof(flowdlo_color_band::least_piece_px2);
  static_assert(sizeof(flowdlo_color_band) == kFirstBytes);
};

template <>
struct Kind<flowdlo_height_band> {
  static constexpr const char* kName = "flowdlo_height_band";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_height_band, reserved) + sizeof(flowdlo_height_band::reserved);
  static_assert(sizeof(flowdlo_height_band) == kFirstBytes);
};

template <>
struct Kind<flowdlo_seed_growth> {
  static constexpr const char* kName = "flowdlo_seed_growth";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_seed_growth, smooth) + sizeof(flowdlo_seed_growth::smooth);
  static_assert(sizeof(flowdlo_seed_growth) == kFirstBytes);
};

template <>
struct Kind<flowdlo_hints> {
  static constexpr const char* kName = "flowdlo_hints";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_hints, reserved) + sizeof(flowdlo_hints::reserved);
  static_assert(sizeof(flowdlo_hints) == kFirstBytes);
};

template <>
struct Kind<flowdlo_tracking> {
  static constexpr const char* kName = "flowdlo_tracking";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_tracking, reserved) + sizeof(flowdlo_tracking::reserved);
  static_assert(sizeof(flowdlo_tracking) == kFirstBytes);
};

template <>
struct Kind<flowdlo_crossing> {
  static constexpr const char* kName = "flowdlo_crossing";
  static constexpr std::size_t kFirstBytes =
      offsetof(flowdlo_crossing, reserved) + sizeof(flowdlo_crossing::reserved);
  static_assert(sizeof(flowdlo_crossing) == kFirstBytes);
};

/// The struct is there and of a size that it has had.
template <class Struct>
[[nodiscard]] Result<void> check_size(const Struct* given, std::size_t bytes) {
  using Known = Kind<Struct>;
  if (given == nullptr) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{0}: expected a {0}, got NULL; pass its address", Known::kName)};
  }
  if (bytes == Known::kFirstBytes || bytes == sizeof(Struct)) return {};
  const std::string expected = Known::kFirstBytes == sizeof(Struct)
                                   ? fmt::format("{}", sizeof(Struct))
                                   : fmt::format("{} or {}", Known::kFirstBytes, sizeof(Struct));
  return Error{ErrorCode::kBadInput,
               fmt::format("{0}.struct_size: expected {1} bytes, got {2}; fill the struct with "
                           "{0}_init before use{3}",
                           Known::kName, expected, bytes,
                           bytes > sizeof(Struct) ? ", and run with a library no older than the "
                                                    "header (this is " FLOWDLO_VERSION ")"
                                                  : "")};
}

/// The same of a struct that says its size itself.
template <class Struct>
[[nodiscard]] Result<void> check_size(const Struct* given) {
  return check_size(given, given == nullptr ? 0 : given->struct_size);
}

/// Writes `value` to a struct of `bytes`, as check_size() has passed them.
template <class Struct>
void write(Struct* given, std::size_t bytes, Struct value) {
  value.struct_size = bytes;
  std::memcpy(given, &value, bytes);
}

/// What a struct that check_size() has passed says; fields that it is too old for are `defaults`'.
template <class Struct>
[[nodiscard]] Struct read(const Struct* given, Struct defaults) {
  std::memcpy(&defaults, given, given->struct_size);
  return defaults;
}

}  // namespace flowdlo::c_api
