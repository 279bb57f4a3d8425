// Processes that estimate the same frame at the same time: the same bytes in every result folder.
// FLOWDLO_REPEATS / 10 is how many there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "support/source_dir.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;

constexpr int kFewest = 4;
constexpr int kAtOnce = 4;

int processes() {
  const char* const repeats = std::getenv("FLOWDLO_REPEATS");
  return repeats == nullptr ? kFewest : std::max(kFewest, std::atoi(repeats) / 10);
}

/// Everything that does not tell the time, by file.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == "overlay.png") continue;  // has the milliseconds written on it
    std::string content = test::read_text(entry.path());
    if (name == "estimate.json") {
      auto json = nlohmann::json::parse(content);
      json.erase("timings_ms");
      json.erase("device_timings_ms");
      content = json.dump();
    }
    files[name] = std::move(content);
  }
  return files;
}

void expect_same_bytes(const std::string& device) {
  const test::TemporaryFolder scratch;
  const fs::path frame = test::source_dir() / "examples/frames/overhand_loop";
  const auto run = [&](int i) {
    const fs::path own = scratch.path() / std::to_string(i);
    fs::create_directories(own);
    const auto outcome = test::run_flowdlo(
        own, {"estimate", frame.string(), "--out", (own / "out").string(), "--device", device,
              "--draws", "2", "--steps", "2", "--threads", std::to_string(i % 3), "--tensors"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return results_in(own / "out" / "overhand_loop");
  };
  const auto first = run(0);
  ASSERT_TRUE(first.count("centerline.csv") == 1 && first.count("prediction.npy") == 1);
  for (int begin = 1; begin < processes(); begin += kAtOnce) {
    std::vector<std::future<std::map<std::string, std::string>>> others;
    for (int i = begin; i < std::min(begin + kAtOnce, processes()); ++i) {
      others.push_back(std::async(std::launch::async, run, i));
    }
    for (auto& other : others) EXPECT_TRUE(other.get() == first);
  }
}

TEST(Processes, SideBySideWriteTheSameBytesOnTheCpu) { expect_same_bytes("cpu"); }

TEST(Processes, SideBySideWriteTheSameBytesOnVulkan) {
  const test::TemporaryFolder scratch;
  const auto survey = nlohmann::json::parse(
      test::run_flowdlo(scratch.path(), {"devices", "--json"}).out, nullptr, false);
  ASSERT_TRUE(survey.contains("advice"));
  if (survey["advice"] != "") GTEST_SKIP() << survey["advice"].get<std::string>();
  expect_same_bytes("vulkan");
}

}  // namespace
}  // namespace flowdlo
