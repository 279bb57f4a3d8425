// The command on a machine that lacks some part of Vulkan: it says which, and what to install.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "frame/temporary_folder.hpp"
#include "support/variable.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

using Json = nlohmann::json;
using test::Drivers;
using test::run_flowdlo;
using test::TemporaryFolder;
using test::Variable;
using test::write_text;
using testing::HasSubstr;

class MissingVulkan : public ::testing::Test {
 protected:
  /// The survey's text has `what`, and so has the error of an estimate on a Vulkan device.
  void expect_told(const std::string& what) const {
    const auto devices = run_flowdlo(scratch_.path(), {"devices"});
    EXPECT_EQ(devices.exit_code, 0) << devices.err;
    EXPECT_THAT(devices.out, HasSubstr(what));
    EXPECT_THAT(devices.out, HasSubstr("--device auto takes: cpu"));
    const auto estimate =
        run_flowdlo(scratch_.path(), {"estimate", test::write_frame(scratch_.path()).string(),
                                      "--out", (scratch_.path() / "out").string(), "--weights",
                                      FLOWDLO_WEIGHTS, "--device", "vulkan"});
    EXPECT_EQ(estimate.exit_code, 2);
    EXPECT_THAT(estimate.err, HasSubstr(what));
  }
  [[nodiscard]] Json survey() const {
    return Json::parse(run_flowdlo(scratch_.path(), {"devices", "--json"}).out);
  }

  TemporaryFolder scratch_;
};

TEST_F(MissingVulkan, WithoutALoaderNamesItsPackageAndADriver) {
  write_text(scratch_.path() / "libvulkan.so.1", "");  // no library: the linker refuses it
  const Variable path("LD_LIBRARY_PATH", scratch_.path().string());
  expect_told("expected the loader libvulkan.so.1");
  expect_told("install libvulkan1 and a driver (mesa-vulkan-drivers");
  EXPECT_EQ(survey()["loader"], "none");
}

TEST_F(MissingVulkan, WithoutADriverNamesItsPackage) {
  const Drivers none(scratch_.path() / "no_driver.json");
  expect_told("expected a driver, got none");
  expect_told("install one (mesa-vulkan-drivers");
  const Json json = survey();
  EXPECT_NE(json["loader"], "none");
  EXPECT_THAT(json["advice"].get<std::string>(), HasSubstr("no_driver.json"))
      << "a variable that hides the drivers is the likeliest reason";
}

TEST_F(MissingVulkan, WithADriverThatFindsNoDeviceSaysWhereToLook) {
  const auto manifest = scratch_.path() / "empty.json";
  write_text(manifest,
             Json{{"file_format_version", "1.0.0"},
                  {"ICD", {{"library_path", FLOWDLO_EMPTY_DRIVER}, {"api_version", "1.1.0"}}}}
                 .dump());
  const Drivers empty(manifest);
  expect_told("expected a device, got drivers that found none");
  expect_told("/dev/dri");
}

TEST_F(MissingVulkan, NothingIsAdvisedWhereADeviceIsUsable) {
  const Json json = survey();
  bool usable = false;
  for (const auto& device : json["vulkan"]) usable = usable || device["lacks"].empty();
  EXPECT_EQ(json["advice"].get<std::string>().empty(), usable) << json.dump(2);
}

}  // namespace
}  // namespace flowdlo
