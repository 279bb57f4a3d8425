// The command on a machine whose Vulkan drivers crash or hang: a line for each, and an estimate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "frame/temporary_folder.hpp"
#include "support/variable.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::Drivers;
using test::read_text;
using test::run_flowdlo;
using test::TemporaryFolder;
using test::Variable;
using testing::HasSubstr;

class BadDrivers : public ::testing::Test {
 protected:
  [[nodiscard]] Json survey() const {
    const auto outcome = run_flowdlo(scratch_.path(), {"devices", "--json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  /// The nodes of an estimate, as text: the same bits are the same text.
  [[nodiscard]] std::string nodes(const std::string& device) const {
    const auto frame = test::write_frame(scratch_.path());
    const auto out = scratch_.path() / "out";
    fs::remove_all(out);
    const auto outcome = run_flowdlo(
        scratch_.path(), {"estimate", frame.string(), "--out", out.string(), "--weights",
                          FLOWDLO_WEIGHTS, "--device", device, "--draws", "1", "--steps", "1"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_text(out / frame.filename() / "centerline.csv");
  }
  /// A manifest of this machine with a device that works; empty without one.
  [[nodiscard]] std::string good_driver() const {
    const Json json = survey();
    const bool usable = std::any_of(json["vulkan"].begin(), json["vulkan"].end(),
                                    [](const Json& device) { return device["lacks"].empty(); });
    for (const Json& driver : json["drivers"]) {
      if (usable && driver["devices"] > 0) return driver["manifest"];
    }
    return {};
  }
  [[nodiscard]] std::size_t loads() const { return fs::exists(log_) ? read_text(log_).size() : 0; }

  TemporaryFolder scratch_;
  fs::path log_ = scratch_.path() / "loads";
  Variable logged_{"FALSE_DRIVER_LOG", log_.string()};
  Variable cache_{"FLOWDLO_CACHE", (scratch_.path() / "cache").string()};
  Variable limit_{"FLOWDLO_PROBE_MS", "5000"};
  Variable narrow_{"LP_NATIVE_VECTOR_WIDTH", "256"};  // one set of variables for every process
};

TEST_F(BadDrivers, CostOneProbeAndALineEach) {
  const Drivers drivers(std::string(FLOWDLO_DRIVER_THAT_ABORTS) + ":" + FLOWDLO_DRIVER_THAT_SLEEPS +
                        ":" + FLOWDLO_DRIVER_THAT_EXITS);
  const auto first = run_flowdlo(scratch_.path(), {"devices"});
  EXPECT_EQ(first.exit_code, 0) << first.err;
  const auto line = [](const char* manifest, const char* verdict) {
    return std::string("LEFT ALONE ") + manifest + ": " + verdict;
  };
  const std::string aborts =
      line(FLOWDLO_DRIVER_THAT_ABORTS,
           "crashed: ended its process by SIGABRT when FlowDLO listed its devices");
  const std::string sleeps =
      line(FLOWDLO_DRIVER_THAT_SLEEPS, "hung: not back after 5.0 s when FlowDLO made its instance");
  const std::string exits =
      line(FLOWDLO_DRIVER_THAT_EXITS,
           "crashed: ended its process by exit status 0 when FlowDLO listed its devices");
  for (const std::string& said : {aborts, sleeps, exits}) {
    EXPECT_THAT(first.out, HasSubstr(said + "\n"));
  }
  EXPECT_THAT(first.out, HasSubstr("--device auto takes: cpu"));
  EXPECT_EQ(loads(), 3U);
  const auto second = run_flowdlo(scratch_.path(), {"devices"});
  for (const std::string& said : {aborts, sleeps, exits}) {
    EXPECT_THAT(second.out, HasSubstr(said + " (remembered)\n"));
  }
  EXPECT_EQ(loads(), 3U) << "the second run asks nobody";
}

TEST_F(BadDrivers, DoNotKeepTheOthersFromTheirWork) {
  std::optional<Variable> patience(std::in_place, "FLOWDLO_PROBE_MS", "60000");
  const std::string good = good_driver();
  if (good.empty()) GTEST_SKIP() << "no usable Vulkan device";
  std::string vulkan_alone;
  std::string auto_alone;
  {
    const Drivers drivers(good);
    vulkan_alone = nodes("vulkan");
    auto_alone = nodes("auto");
  }
  ASSERT_FALSE(vulkan_alone.empty());
  patience.reset();  // the good one's verdict is remembered
  const Drivers drivers(std::string(FLOWDLO_DRIVER_THAT_ABORTS) + ":" + good + ":" +
                        FLOWDLO_DRIVER_THAT_SLEEPS);
  EXPECT_EQ(nodes("vulkan"), vulkan_alone);
  EXPECT_EQ(nodes("auto"), auto_alone);
  EXPECT_EQ(loads(), 2U);
  const Json json = survey();
  ASSERT_EQ(json["drivers"].size(), 3U);
  EXPECT_FALSE(json["drivers"][0]["used"]);
  EXPECT_TRUE(json["drivers"][1]["used"]);
  EXPECT_FALSE(json["drivers"][2]["used"]);
  EXPECT_FALSE(json["vulkan"].empty());
}

TEST_F(BadDrivers, AreLoadedUnseenWhereTheProbeIsMissing) {
  // A copy of the command and of the library, without what lies beside them.
  const fs::path bare = scratch_.path() / "bare";
  fs::create_directories(bare);
  fs::copy_file(FLOWDLO_COMMAND, bare / "flowdlo");
  const fs::path library = FLOWDLO_LIBRARY_FILE;
  if (library.extension() == ".a") GTEST_SKIP() << "flowdlo is static in this build";
  fs::copy_file(library, bare / FLOWDLO_LIBRARY_SONAME);
  const Variable path("LD_LIBRARY_PATH", bare.string());
  const auto outcome = test::run_program(scratch_.path(), bare / "flowdlo", {"devices"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Drivers are loaded unseen: libexec/flowdlo/flowdlo-probe-"));
}

/// Mesa's driver compiles for cards that are not there, and lists them as GPUs without memory.
TEST(AbsentGpu, IsSurveyedWithoutACrash) {
  const TemporaryFolder scratch;
  const Variable cache("FLOWDLO_CACHE", (scratch.path() / "cache").string());
  for (const char* const family : {"vega10", "navi21"}) {  // of 64 and of 32 lanes
    const Variable forced("RADV_FORCE_FAMILY", family);
    const auto outcome = run_flowdlo(scratch.path(), {"devices", "--json"});
    ASSERT_EQ(outcome.exit_code, 0) << family << ": " << outcome.err;
    EXPECT_EQ(Json::parse(outcome.out)["auto_choice"], "cpu") << outcome.out;
  }
}

}  // namespace
}  // namespace flowdlo
