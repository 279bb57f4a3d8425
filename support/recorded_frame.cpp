#include "recorded_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "durability_choice.hpp"

namespace flowdlo::support {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre_m = 0.001;
constexpr double kTenth_m = 0.0001;
constexpr float kFarthestTenth_m = 6.5F;  // what 16 bits hold
constexpr float kFarthest_m = 65.0F;
constexpr float kWhole = 1e-3F;  // of a millimetre

double scale_of(const std::vector<float>& depth_m) {
  const bool whole = std::all_of(depth_m.begin(), depth_m.end(), [](float depth) {
    const float millimetres = 1000 * depth;
    return std::abs(millimetres - std::round(millimetres)) < kWhole;
  });
  const bool near = std::all_of(depth_m.begin(), depth_m.end(),
                                [](float depth) { return depth < kFarthestTenth_m; });
  return !whole && near ? kTenth_m : kMillimetre_m;
}

}  // namespace

fs::path recorded_frame_folder(const fs::path& out, const FrameEntry& entry) {
  return out / "frames" / entry.folder.stem() / entry.name;
}

Result<FrameFolder> keep_recorded_frame(const fs::path& out, const FrameEntry& entry) {
  auto recorded = entry.read();
  if (!recorded) return recorded;
  const auto folder = recorded_frame_folder(out, entry);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    return Error{ErrorCode::kIo,
                 fmt::format("{}: cannot be made: {}", folder.string(), failure.message())};
  }
  auto depth_m = recorded->depth_m;
  for (float& depth : depth_m) {
    if (!(depth > 0 && depth < kFarthest_m)) depth = 0;
  }
  Frame frame = recorded->frame();
  frame.depth_m = depth_m;
  if (const auto valid = validate(frame); !valid) return recorded;  // its row will say so
  if (auto saved =
          save_frame_folder(folder, frame, scale_of(depth_m), nullptr, chosen_durability());
      !saved) {
    return saved.error();
  }
  return recorded;
}

}  // namespace flowdlo::support
