#include "rope_core.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flowdlo/flowdlo.hpp"

namespace flowdlo_ros {
namespace {

/// What is wrong with a message, on its way to Seen::error.
class Unusable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void check_shape(const char* name, const Image& image, std::size_t pixel_bytes) {
  const std::size_t row = pixel_bytes * image.width;
  const bool whole = image.width > 0 && image.height > 0 && image.step >= row &&
                     image.bytes >= std::size_t{image.step} * (image.height - 1) + row;
  if (whole) return;
  throw Unusable(std::string(name) + ": expected rows of " + std::to_string(row) + " bytes, " +
                 std::to_string(image.height) + " of them, got " + std::to_string(image.bytes) +
                 " bytes in steps of " + std::to_string(image.step));
}

void check_endian(const char* name, const Image& image) {
  if (image.big_endian == (std::endian::native == std::endian::big)) return;
  throw Unusable(std::string(name) + ": expected this machine's byte order; convert the image");
}

template <class Value, class Put>
void for_each_pixel(const Image& image, const Put& put) {
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::uint8_t* const row = image.data + std::size_t{v} * image.step;
    for (std::uint32_t u = 0; u < image.width; ++u) {
      Value value;
      std::memcpy(&value, row + u * sizeof(Value), sizeof(Value));
      put(value);
    }
  }
}

std::vector<float> depth_of(const Image& image) {
  constexpr double kMillimetre_m = 0.001;
  std::vector<float> depth_m;
  if (image.encoding == "16UC1" || image.encoding == "mono16") {
    check_shape("depth", image, 2);
    check_endian("depth", image);
    for_each_pixel<std::uint16_t>(image, [&](std::uint16_t units) {
      depth_m.push_back(static_cast<float>(units * kMillimetre_m));
    });
  } else if (image.encoding == "32FC1") {
    check_shape("depth", image, 4);
    check_endian("depth", image);
    for_each_pixel<float>(image, [&](float metres) { depth_m.push_back(metres); });
  } else {
    throw Unusable("depth: expected 16UC1, mono16 (millimetres) or 32FC1 (metres), got \"" +
                   image.encoding + "\"");
  }
  return depth_m;
}

std::vector<std::uint8_t> mask_of(const Image& image) {
  if (image.encoding != "mono8" && image.encoding != "8UC1") {
    throw Unusable("mask: expected mono8 or 8UC1, the rope over 127, got \"" + image.encoding +
                   "\"");
  }
  check_shape("mask", image, 1);
  std::vector<std::uint8_t> mask;
  for_each_pixel<std::uint8_t>(image, [&](std::uint8_t value) { mask.push_back(value); });
  return mask;
}

std::vector<std::uint8_t> color_of(const Image& image) {
  const bool rgb = image.encoding == "rgb8";
  if (!rgb && image.encoding != "bgr8" && image.encoding != "8UC3") {
    throw Unusable("color: expected bgr8 or rgb8, got \"" + image.encoding + "\"");
  }
  check_shape("color", image, 3);
  std::vector<std::uint8_t> bgr;
  for_each_pixel<std::array<std::uint8_t, 3>>(image, [&](std::array<std::uint8_t, 3> pixel) {
    if (rgb) std::swap(pixel[0], pixel[2]);
    bgr.insert(bgr.end(), pixel.begin(), pixel.end());
  });
  return bgr;
}

flowdlo::Intrinsics intrinsics_of(const Camera& camera, bool rectified) {
  const auto number = [](double value) { return static_cast<float>(value); };
  if (rectified) {
    return {number(camera.p[0]), number(camera.p[5]), number(camera.p[2]), number(camera.p[6])};
  }
  const bool straight =
      std::all_of(camera.d.begin(), camera.d.end(), [](double d) { return std::abs(d) < 1e-6; });
  if (!straight) {
    throw Unusable(
        "camera_info: expected no distortion (D), got some; rectify the images by "
        "image_proc and set ~rectified");
  }
  return {number(camera.k[0]), number(camera.k[4]), number(camera.k[2]), number(camera.k[5])};
}

Rope rope_of(const flowdlo::Estimate& estimate) {
  Rope rope;
  for (const auto& node : estimate.nodes) rope.nodes.push_back({node.x, node.y, node.z});
  rope.sigma_m.assign(estimate.sigma_m.begin(), estimate.sigma_m.end());
  rope.support.assign(estimate.support.begin(), estimate.support.end());
  rope.confidence = estimate.confidence;
  rope.source = name_of(estimate.source);
  rope.origin = name_of(estimate.origin);
  for (const auto doubt : estimate.one_rope.doubts) rope.doubts.emplace_back(name_of(doubt));
  rope.closed = estimate.closed;
  return rope;
}

std::optional<flowdlo::Quality> quality_of(const std::string& name) {
  if (name == "full") return flowdlo::Quality::kFull;
  if (name == "fast") return flowdlo::Quality::kFast;
  if (name == "auto") return flowdlo::Quality::kAuto;
  return std::nullopt;
}

/// The mask that the choices ask for, of a frame that has none.
flowdlo::Mask made_mask(const flowdlo::Frame& frame, const Choices& choices) {
  std::vector<flowdlo::Result<flowdlo::Mask>> ways;
  if (choices.rope_color.size() == 3) {
    flowdlo::ColorBand band;
    band.red = static_cast<std::uint8_t>(choices.rope_color[0]);
    band.green = static_cast<std::uint8_t>(choices.rope_color[1]);
    band.blue = static_cast<std::uint8_t>(choices.rope_color[2]);
    band.tolerance = static_cast<float>(choices.color_tolerance);
    ways.push_back(flowdlo::mask_from_color(frame, band));
  }
  if (choices.table) ways.push_back(flowdlo::mask_from_plane(frame, {}));
  if (ways.empty()) throw Unusable("expected a mask, ~rope_color or ~table, got none of them");
  flowdlo::Mask mask(frame.depth_m.size(), 255);
  for (const auto& way : ways) {
    if (!way) throw Unusable(way.error().message);
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] &= (*way)[i];
  }
  return mask;
}

}  // namespace

struct RopeCore::Impl {
  std::optional<flowdlo::Tracker> tracker;
  int ropes = 1;
  bool ring = false;
  std::optional<flowdlo::Pixel> end;

  Seen estimate(const flowdlo::Frame& frame, bool keep_order) {
    return ropes == 1 ? estimate_one(frame, keep_order) : estimate_ropes(frame, keep_order);
  }

  Seen estimate_one(const flowdlo::Frame& frame, bool keep_order) {
    if (!keep_order) tracker->forget();
    flowdlo::Hints hints;
    if (end) hints.first_end = *end;
    if (ring) hints.closed = true;
    const auto one = tracker->estimate(frame, hints);
    if (!one) return {.error = one.error().message};
    Seen seen;
    seen.ropes.push_back(rope_of(*one));
    seen.ropes.back().number = keep_order ? 1 : 0;
    seen.total_ms = one->timings.total_ms;
    return seen;
  }

  Seen estimate_ropes(const flowdlo::Frame& frame, bool keep_order) {
    flowdlo::Ropes all;
    Seen seen;
    std::vector<int> numbers;
    if (keep_order) {
      auto tracked = tracker->estimate_ropes(frame);
      if (!tracked) return {.error = tracked.error().message};
      all = std::move(tracked->found);
      numbers = std::move(tracked->numbers);
      seen.missing.assign(tracked->missing.begin(), tracked->missing.end());
    } else {
      auto alone = tracker->estimator()->estimate_ropes(frame);
      if (!alone) return {.error = alone.error().message};
      all = *std::move(alone);
      numbers.assign(all.ropes.size(), 0);
    }
    for (std::size_t i = 0; i < all.ropes.size(); ++i) {
      seen.ropes.push_back(rope_of(all.ropes[i]));
      seen.ropes.back().number = static_cast<std::uint32_t>(numbers[i]);
    }
    for (const auto& at : all.crossings) {
      seen.crossings.push_back({static_cast<std::uint32_t>(at.over),
                                static_cast<std::uint32_t>(at.under), at.over_at_m, at.under_at_m,
                                at.apart_m});
    }
    seen.total_ms = all.total_ms;
    return seen;
  }
};

RopeCore::RopeCore(const Setup& setup, std::string& error) : impl_(std::make_unique<Impl>()) {
  flowdlo::Config config;
  config.weights = setup.weights;
  config.device = setup.device;
  const auto quality = quality_of(setup.quality);
  error = quality ? "" : "~quality: expected full, fast or auto, got \"" + setup.quality + "\"";
  if (!quality) return;
  config.quality = *quality;
  if (setup.ring && setup.ropes != 1) {
    error = "~ring: expected ~ropes 1 beside it, got " + std::to_string(setup.ropes);
    return;
  }
  config.ropes = setup.ropes;
  config.threads = setup.threads;
  config.rope_length_m = setup.rope_length_m;
  config.budget_ms = setup.budget_ms;
  config.seed = setup.seed;
  auto made = flowdlo::Tracker::create(
      config, {.most_moved_m = setup.most_moved_m, .patience = setup.patience});
  if (!made) {
    error = made.error().message;
    return;
  }
  impl_->ropes = setup.ropes;
  impl_->ring = setup.ring;
  impl_->tracker = *std::move(made);
}

RopeCore::~RopeCore() = default;

Seen RopeCore::see(const Image& depth, const Image& mask, const Image& color, const Camera& camera,
                   const Choices& choices) {
  if (!impl_->tracker) return {.error = "the estimator was not made"};
  try {
    const auto depth_m = depth_of(depth);
    const auto color_bgr = color.data == nullptr ? std::vector<std::uint8_t>{} : color_of(color);
    flowdlo::Frame frame{static_cast<int>(depth.width),
                         static_cast<int>(depth.height),
                         intrinsics_of(camera, choices.rectified),
                         depth_m,
                         {},
                         color_bgr};
    for (const auto* other : {&mask, &color}) {
      if (other->data == nullptr) continue;
      if (other->width == depth.width && other->height == depth.height) continue;
      throw Unusable("expected images of one size, got " + std::to_string(depth.width) + " x " +
                     std::to_string(depth.height) + " and " + std::to_string(other->width) + " x " +
                     std::to_string(other->height) + "; align them");
    }
    const auto rope = mask.data == nullptr ? made_mask(frame, choices) : mask_of(mask);
    frame.mask = rope;
    return impl_->estimate(frame, choices.keep_order);
  } catch (const std::exception& fault) {
    return {.error = fault.what()};
  }
}

void RopeCore::reset() {
  if (impl_->tracker) impl_->tracker->forget();
  impl_->end.reset();
}

void RopeCore::set_end(float u, float v) { impl_->end = flowdlo::Pixel{u, v}; }

}  // namespace flowdlo_ros
