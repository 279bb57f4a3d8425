#include "baselines/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include <utility>
#include "files/regular_file.hpp"

namespace flowdlo::baselines {
namespace {

constexpr std::uint64_t kMostBytes = 1U << 20U;  // of meta.json

bool read_triple(const nlohmann::json& json, const char* key, std::array<int, 3>& values) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() != values.size()) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& value = (*found)[i];
    if (!value.is_number_integer() || value < 0 || value > 255) return false;
    values[i] = value.get<int>();
  }
  return true;
}

Result<std::optional<HsvBand>> read_band(const std::filesystem::path& folder) {
  const auto file = folder / "meta.json";
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) return std::optional<HsvBand>();
  const auto content = files::read_text(file, kMostBytes);
  if (!content) return content.error();
  const auto json = nlohmann::json::parse(*content, nullptr, false);
  const Error bad{ErrorCode::kBadInput,
                  fmt::format("{}: expected \"hsv_band\" with \"low\" and \"high\" of three whole "
                              "numbers 0..255 each; mend the file, or remove it",
                              file.string())};
  if (!json.is_object()) return bad;
  const auto found = json.find("hsv_band");
  if (found == json.end()) return std::optional<HsvBand>();
  HsvBand band;
  if (!found->is_object() || !read_triple(*found, "low", band.low) ||
      !read_triple(*found, "high", band.high)) {
    return bad;
  }
  return std::optional<HsvBand>(band);
}

}  // namespace

Result<Observation> observe(FrameFolder frame, const std::filesystem::path& folder) {
  auto band = read_band(folder);
  if (!band) return band.error();
  return Observation{std::move(frame), *band};
}

Result<Observation> read_observation(const std::filesystem::path& folder) {
  auto frame = load_frame_folder(folder);
  if (!frame) return frame.error();
  return observe(*std::move(frame), folder);
}

cv::Mat frame_mask(const FrameFolder& folder) {
  cv::Mat mask(folder.height, folder.width, CV_8U);
  std::transform(folder.mask.begin(), folder.mask.end(), mask.begin<std::uint8_t>(),
                 [](std::uint8_t value) { return value > 127 ? 255 : 0; });
  return mask;
}

cv::Mat hsv_mask(const Observation& observation) {
  const FrameFolder& folder = observation.folder;
  if (!observation.band || folder.color_bgr.empty()) return frame_mask(folder);
  cv::Mat color(folder.height, folder.width, CV_8UC3);
  std::copy(folder.color_bgr.begin(), folder.color_bgr.end(), color.data);
  cv::Mat hsv;
  cv::cvtColor(color, hsv, cv::COLOR_BGR2HSV);
  const auto scalar = [](const std::array<int, 3>& v) { return cv::Scalar(v[0], v[1], v[2]); };
  cv::Mat mask;
  cv::inRange(hsv, scalar(observation.band->low), scalar(observation.band->high), mask);
  return mask;
}

}  // namespace flowdlo::baselines
