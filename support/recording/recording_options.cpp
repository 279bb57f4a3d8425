#include "recording/recording_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "frame/faults.hpp"

namespace flowdlo::recording {

Result<void> check(const RecordingOptions& options, const std::string& who) {
  frame::Faults faults;
  const auto expect = [&](bool holds, const std::string& words) {
    if (!holds) faults.bad_input(who + ": expected " + words);
  };
  expect(options.hsv.has_value() == options.mask_topic.empty(),
         fmt::format("one way to the rope's mask, got {}; give --hsv or --mask-topic",
                     options.hsv ? "two" : "none"));
  if (options.hsv) {
    const auto& h = *options.hsv;
    constexpr int kMostHue = 179;
    constexpr int kMost = 255;
    const bool fit = *std::min_element(h.begin(), h.end()) >= 0 && h[0] <= kMostHue &&
                     h[3] <= kMostHue && h[1] <= h[4] && h[2] <= h[5] && h[4] <= kMost &&
                     h[5] <= kMost;
    expect(fit, fmt::format("--hsv with hues of 0 to 179, saturations and values of 0 to 255, the "
                            "low one first, got {}",
                            fmt::join(h, ",")));
  }
  expect(options.sync_tolerance_ms >= 0 && std::isfinite(options.sync_tolerance_ms),
         "a --sync-tolerance of 0 ms or more");
  expect(options.every >= 1, "--every of 1 or more");
  expect(options.from_s <= options.to_s,
         fmt::format("--from before --to, got {:g} s and {:g} s", options.from_s, options.to_s));
  if (faults.empty()) return {};
  return faults.error();
}

}  // namespace flowdlo::recording
