#include <filesystem>
#include <fstream>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

namespace fs = std::filesystem;

/// A folder of this test's own, removed at its end.
class PipelineCache : public ::testing::Test {
 protected:
  PipelineCache()
      : folder_(fs::path(::testing::TempDir()) /
                ("flowdlo_pipelines_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this) % 1000003))) {
    fs::remove_all(folder_);
  }
  ~PipelineCache() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  /// Normalises a few rows on a device that has compiled nothing yet.
  Outputs run() {
    const auto device = open_device({.wanted = report(*devices().front()).uuid});
    EXPECT_TRUE(device);
    Trial trial(create_program(*device, {.timeout_ms = 60000, .pipeline_cache = folder_}));
    const auto x = trial.input(64, 4, noise(256, 1));
    const auto norm = trial.input(1, 4, {0, 0, 0, 2});
    trial->record(ops::Normalize{.points = x, .norm = norm, .out = trial.output(64, 4)});
    return trial.run();
  }

  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      if (entry.path().extension() != ".gemm") found.push_back(entry.path());  // see tuning_test
    }
    return found;
  }

  fs::path folder_;
};

TEST_F(PipelineCache, KeepsOneFileADeviceAndNoTemporaryOnes) {
  FLOWDLO_NEEDS_DEVICE();
  const Outputs first = run();
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(files()[0].extension(), ".pipelines");
  EXPECT_EQ(run(), first);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(PipelineCache, IgnoresDamagedFiles) {
  FLOWDLO_NEEDS_DEVICE();
  const Outputs first = run();
  const fs::path file = files().at(0);
  const auto whole = fs::file_size(file);
  fs::resize_file(file, whole - 1);  // truncated
  EXPECT_EQ(run(), first);
  {
    std::ofstream broken(file, std::ios::binary | std::ios::trunc);
    broken << std::string(300, 'x');  // hostile
  }
  EXPECT_EQ(run(), first);
  EXPECT_EQ(fs::file_size(files().at(0)), whole) << "written anew";
}

TEST_F(PipelineCache, ThatCannotBeWrittenDoesNotMatter) {
  FLOWDLO_NEEDS_DEVICE();
  {
    std::ofstream in_the_way(folder_);
    in_the_way << "a file where the folder should be";
  }
  EXPECT_EQ(run().size(), 1U);
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
