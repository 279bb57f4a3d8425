// Observation: what a baseline sees of one frame folder.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// Colours of one material, OpenCV's ranges (hue 0..180), inclusive.
struct HsvBand {
  std::array<int, 3> low{};
  std::array<int, 3> high{};
};

struct Observation {
  FrameFolder folder;
  /// "hsv_band" of meta.json, Sec. 4.1.2. Without one, or without colour, the frame's own mask
  /// stands in for the thresholds.
  std::optional<HsvBand> band;
};

/// Fails as load_frame_folder does, and with kBadInput where "hsv_band" has another form.
[[nodiscard]] Result<Observation> read_observation(const std::filesystem::path& folder);

/// The same from a frame that is read already.
[[nodiscard]] Result<Observation> observe(FrameFolder frame, const std::filesystem::path& folder);

/// [height, width] u8, 0 or 255: the band's pixels, or the frame's mask without a band.
[[nodiscard]] cv::Mat hsv_mask(const Observation& observation);

/// [height, width] u8, 0 or 255: the frame's mask.
[[nodiscard]] cv::Mat frame_mask(const FrameFolder& folder);

}  // namespace flowdlo::baselines
