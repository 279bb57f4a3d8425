#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

using Json = nlohmann::json;
using test::run_flowdlo;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(DevicesCommand, SaysWhichDeviceAutoTakes) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"devices"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("--device auto takes: "));
}

TEST(DevicesCommand, DoctorIsAnotherNameForIt) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"doctor", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(Json::accept(outcome.out));
}

TEST(DevicesCommand, JsonListsEveryDeviceAndNeverTakesACpuDriverByItself) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"devices", "--json"});
  ASSERT_TRUE(Json::accept(outcome.out)) << outcome.out;
  const auto json = Json::parse(outcome.out);
  EXPECT_TRUE(json["loader"].is_string());
  ASSERT_TRUE(json["vulkan"].is_array());
  for (const auto& device : json["vulkan"]) {
    for (const char* field : {"name", "kind", "driver", "api_version", "uuid", "self_test"}) {
      EXPECT_TRUE(device[field].is_string()) << field;
    }
    EXPECT_TRUE(device["lacks"].is_array());
    if (device["kind"] == "cpu") {
      EXPECT_NE(json["auto_choice"], device["name"]);
    }
  }
}

}  // namespace
}  // namespace flowdlo
