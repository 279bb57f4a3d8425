#include "train/mask_runs.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo::train {

MaskRuns runs_of(const Frame& frame) {
  constexpr std::uint8_t kThreshold = 127;
  MaskRuns mask{frame.width, frame.height, {}};
  for (int v = 0; v < frame.height; ++v) {
    const auto row = frame.mask.subspan(static_cast<std::size_t>(v) * frame.width,
                                        static_cast<std::size_t>(frame.width));
    for (int u = 0; u < frame.width;) {
      if (row[static_cast<std::size_t>(u)] <= kThreshold) {
        ++u;
        continue;
      }
      const int first = u;
      while (u < frame.width && row[static_cast<std::size_t>(u)] > kThreshold) ++u;
      mask.runs.push_back({static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(first),
                           static_cast<std::uint16_t>(u - first)});
    }
  }
  return mask;
}

std::vector<std::uint8_t> image_of(const MaskRuns& mask) {
  std::vector<std::uint8_t> image(static_cast<std::size_t>(mask.width) * mask.height, 0);
  for (const MaskRun& run : mask.runs) {
    const auto start = static_cast<std::ptrdiff_t>(run.v) * mask.width + run.u;
    std::fill_n(image.begin() + start, run.length, std::uint8_t{255});
  }
  return image;
}

}  // namespace flowdlo::train
