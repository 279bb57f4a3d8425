// What the functions of files do when memory runs out: an Error or the right bytes.
#include <gmock/gmock.h>

#include <filesystem>
#include <iterator>

#include "flowdlo/devices.hpp"
#include "flowdlo/frame_folder.hpp"
#include "flowdlo/weights.hpp"
#include "frame/temporary_folder.hpp"
#include "memory/sweep.hpp"
#include "support/estimate_bits.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const FrameFolder& frame) {
  std::string bytes = frame.name;
  append(bytes, frame.intrinsics);
  bytes.append(reinterpret_cast<const char*>(frame.depth_m.data()), frame.depth_m.size() * 4);
  bytes.append(frame.mask.begin(), frame.mask.end());
  bytes.append(frame.color_bgr.begin(), frame.color_bgr.end());
  if (frame.truth) append(bytes, *frame.truth);
  return bytes;
}

/// Of every file, names included; what is left of a failed call would be among them.
std::string files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string bytes;
  for (const auto& file : files) bytes += file.filename().string() + test::read_text(file);
  return bytes;
}

constexpr Depth kShort = {6, 6};  // each call reads and verifies a whole model

class FilesMemory : public ::testing::Test {
 protected:
  test::TemporaryFolder scratch_;
};

TEST_F(FilesMemory, LoadFrameFolderSurvivesEveryAllocation) {
  const fs::path folder = test::write_frame(scratch_.path());
  sweep(
      "load_frame_folder", [&] { return load_frame_folder(folder); },
      [](const Result<FrameFolder>& frame) { return bytes_of(*frame); });
}

TEST_F(FilesMemory, LoadFrameFolderWithoutMaskSurvivesEveryAllocation) {
  const fs::path folder = test::write_frame(scratch_.path());
  fs::remove(folder / "mask.png");
  sweep(
      "load_frame_folder_without_mask", [&] { return load_frame_folder_without_mask(folder); },
      [](const Result<FrameFolder>& frame) { return bytes_of(*frame); });
}

TEST_F(FilesMemory, SaveFrameFolderSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  const std::vector<std::uint8_t> color(wave.mask.size() * 3, 90);
  Frame frame = wave.frame();
  frame.color_bgr = color;
  const Centerline truth{};
  const fs::path folder = scratch_.path() / "saved";
  sweep(
      "save_frame_folder", [&] { return save_frame_folder(folder, frame, 0.001, &truth); },
      [&](const Result<void>&) { return files_of(folder); });
}

TEST_F(FilesMemory, InspectWeightsSurvivesEveryAllocation) {
  const fs::path file = FLOWDLO_WEIGHTS;
  sweep(
      "inspect_weights", [&] { return inspect_weights(file); },
      [](const Result<WeightsInfo>& info) {
        std::string text = info->sha256;
        for (const auto& [key, value] : info->metadata) text += key + value;
        for (const auto& tensor : info->tensors) text += tensor.name + tensor.dtype;
        return text;
      },
      kShort);
}

TEST_F(FilesMemory, ExportAndImportSurviveEveryAllocation) {
  const fs::path file = FLOWDLO_WEIGHTS;
  fs::create_directories(scratch_.path() / "out");
  const fs::path exported = scratch_.path() / "out" / "weights.safetensors";
  const fs::path imported = scratch_.path() / "in" / "weights.fdw";
  fs::create_directories(scratch_.path() / "in");
  sweep(
      "export_safetensors", [&] { return export_safetensors(file, exported); },
      [&](const Result<void>&) { return files_of(exported.parent_path()); }, kShort);
  sweep(
      "import_safetensors", [&] { return import_safetensors(exported, imported); },
      [&](const Result<void>&) { return files_of(imported.parent_path()); }, kShort);
}

TEST_F(FilesMemory, SetFastQualitySurvivesEveryAllocation) {
  const fs::path file = FLOWDLO_WEIGHTS;
  const fs::path output = scratch_.path() / "fast.fdw";
  sweep(
      "set_fast_quality", [&] { return set_fast_quality(file, 2, 1, output); },
      [&](const Result<void>&) { return files_of(scratch_.path()); }, kShort);
}

}  // namespace
}  // namespace flowdlo::testing
