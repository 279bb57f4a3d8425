// A frame folder: an error, or a frame that is valid, and that is saved and loaded without loss.
// The input is its files one after another, kSeparator between them; of length 0: not there.
#include "flowdlo/frame_folder.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include "frame/camera_json.hpp"
#include "png_file.hpp"
#include "promise.hpp"
#include "target.hpp"
#include "working_folder.hpp"

namespace {

namespace fs = std::filesystem;
using flowdlo::FrameFolder;
using flowdlo::fuzz::promise;

constexpr std::array kFiles{"camera.json", "truth.csv", "depth.png", "mask.png", "color.png"};
constexpr std::string_view kSeparator = "--->";

void unpack(std::string_view rest, const fs::path& folder) {
  for (const char* name : kFiles) {
    const auto end = std::min(rest.find(kSeparator), rest.size());
    const auto bytes = rest.substr(0, end);
    rest.remove_prefix(std::min(end + kSeparator.size(), rest.size()));
    fs::remove(folder / name);
    const bool large = flowdlo::fuzz::is_large_png(
        {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (bytes.empty() || large) continue;
    std::ofstream stream(folder / name, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
}

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

void check_saved(const FrameFolder& loaded, double depth_scale_m, const fs::path& folder) {
  const auto* truth = loaded.truth ? &*loaded.truth : nullptr;
  const auto saved = flowdlo::save_frame_folder(folder, loaded.frame(), depth_scale_m, truth);
  promise(saved.has_value(), "a frame that was loaded can be saved");
  const auto again = flowdlo::load_frame_folder(folder);
  promise(again.has_value(), "a frame that was saved can be loaded");
  promise(same_bits(again->mask, loaded.mask), "its mask stays");
  promise(same_bits(again->depth_m, loaded.depth_m), "its depths stay");
  promise(same_bits(again->color_bgr, loaded.color_bgr), "its colours stay");
  promise(again->truth.has_value() == loaded.truth.has_value(), "its truth stays");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flowdlo::fuzz::WorkingFolder folder;
  const fs::path given = folder.path() / "given";
  fs::create_directories(given);
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  unpack(input, given);
  const auto loaded = flowdlo::load_frame_folder(given);
  if (!loaded) {
    promise(!loaded.error().message.empty(), "an error has words");
    return 0;
  }
  promise(flowdlo::validate(loaded->frame()).has_value(), "a frame that was loaded is valid");
  const auto camera =
      flowdlo::frame::parse_camera(input.substr(0, input.find(kSeparator)), "camera.json");
  promise(camera.has_value(), "its camera can be read alone");
  check_saved(*loaded, camera->depth_scale_m, folder.path() / "saved");
  return 0;
}
