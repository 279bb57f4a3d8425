#include "wide_lavapipe.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo::support {
namespace {

using Json = nlohmann::json;

DeviceReport device(const std::string& name, const std::string& driver) {
  DeviceReport report;
  report.name = name;
  report.driver = driver;
  return report;
}

TEST(WideLavapipe, IsForTheMesaThatShufflesRightlyThen) {
  const std::string name = "llvmpipe (LLVM 15.0.6, 512 bits)";
  EXPECT_TRUE(bears_sixteen_lanes(device(name, "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)")));
  EXPECT_FALSE(bears_sixteen_lanes(device(name, "llvmpipe Mesa 25.0.7-2 (LLVM 19.1.7)")));
  EXPECT_FALSE(bears_sixteen_lanes(device(name, "0x1")));
}

TEST(WideLavapipe, LeavesOtherDriversAlone) {
  EXPECT_TRUE(bears_sixteen_lanes(device("NVIDIA H200", "NVIDIA 570.86")));
}

/// The lavapipe that `flowdlo devices` sees with the variable set to `width`, or not at all.
Json lavapipe(const char* width) {
  const test::TemporaryFolder scratch;
  if (width == nullptr) {
    ::unsetenv("LP_NATIVE_VECTOR_WIDTH");
  } else {
    ::setenv("LP_NATIVE_VECTOR_WIDTH", width, 1);
  }
  const auto outcome = test::run_flowdlo(scratch.path(), {"devices", "--json"});
  ::unsetenv("LP_NATIVE_VECTOR_WIDTH");
  if (!Json::accept(outcome.out)) return {};
  const Json survey = Json::parse(outcome.out);
  for (const auto& device : survey["vulkan"]) {
    if (device["name"].get<std::string>().rfind("llvmpipe", 0) == 0) return device;
  }
  return {};
}

TEST(WideLavapipe, LeavesAWidthThatIsSet) {
  const Json device = lavapipe("128");
  if (device.is_null()) GTEST_SKIP() << "no lavapipe";
  EXPECT_EQ(device["subgroup_size"], 4);
}

TEST(WideLavapipe, HasMoreThanEightLanesInTheRightMesaAlone) {
  const Json device = lavapipe(nullptr);
  if (device.is_null()) GTEST_SKIP() << "no lavapipe";
  const bool right = device["driver"].get<std::string>().find("Mesa 22.3.") != std::string::npos;
  EXPECT_LE(device["subgroup_size"].get<int>(), right ? 16 : 8);
  EXPECT_TRUE(device["self_test_passed"].get<bool>()) << device["self_test"];
}

}  // namespace
}  // namespace flowdlo::support
