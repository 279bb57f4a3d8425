#include "estimator/config_check.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

namespace flowdlo::estimator {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// What is said of a configuration in which `change` was made.
std::string fault_of(const std::function<void(Config&)>& change) {
  Config config;
  change(config);
  const auto checked = check(config);
  if (checked) return "none";
  EXPECT_EQ(checked.error().code, ErrorCode::kBadInput);
  return checked.error().message;
}

TEST(ConfigCheck, TheDefaultsPass) { EXPECT_TRUE(check(Config{})); }

TEST(ConfigCheck, ADeviceWithoutANameIsRefused) {
  EXPECT_THAT(fault_of([](Config& c) { c.device = ""; }),
              AllOf(HasSubstr("Config.device"), HasSubstr("got nothing"), HasSubstr("auto")));
}

TEST(ConfigCheck, EnumerationsBeyondTheirNamesAreRefused) {
  for (const int value : {-1, 3, 77}) {
    const std::string got = "expected one of its names, got " + std::to_string(value);
    EXPECT_THAT(fault_of([&](Config& c) { c.quality = static_cast<Quality>(value); }),
                HasSubstr("Config.quality: " + got));
    EXPECT_THAT(fault_of([&](Config& c) { c.prior = static_cast<PriorChoice>(value); }),
                HasSubstr("Config.prior: " + got));
    EXPECT_THAT(fault_of([&](Config& c) { c.gate = static_cast<GateChoice>(value); }),
                HasSubstr("Config.gate: " + got));
    EXPECT_THAT(fault_of([&](Config& c) { c.field = static_cast<FieldChoice>(value); }),
                HasSubstr("Config.field: " + got));
    EXPECT_THAT(fault_of([&](Config& c) { c.field_device = static_cast<FieldDevice>(value); }),
                HasSubstr("Config.field_device: " + got));
  }
}

TEST(ConfigCheck, NumbersOutOfRangeAreRefused) {
  EXPECT_THAT(fault_of([](Config& c) { c.threads = -1; }), HasSubstr("Config.threads"));
  EXPECT_THAT(fault_of([](Config& c) { c.ropes = -1; }), HasSubstr("Config.ropes: expected 0"));
  EXPECT_THAT(fault_of([](Config& c) { c.ropes = kMostRopes + 1; }), HasSubstr("Config.ropes"));
  EXPECT_EQ(fault_of([](Config& c) { c.ropes = kMostRopes; }), "none");
  EXPECT_THAT(fault_of([](Config& c) { c.threads = 1025; }), HasSubstr("Config.threads"));
  EXPECT_THAT(fault_of([](Config& c) { c.max_width = 0; }), HasSubstr("Config.max_width"));
  EXPECT_THAT(fault_of([](Config& c) { c.max_height = 4097; }), HasSubstr("Config.max_height"));
  EXPECT_THAT(fault_of([](Config& c) { c.device_timeout_ms = -5; }),
              HasSubstr("Config.device_timeout_ms"));
  for (const double length_m :
       {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(fault_of([&](Config& c) { c.rope_length_m = length_m; }),
                HasSubstr("Config.rope_length_m"));
    EXPECT_THAT(fault_of([&](Config& c) { c.budget_ms = length_m; }),
                HasSubstr("Config.budget_ms"));
  }
}

TEST(ConfigCheck, EveryFaultIsListedOnALineOfItsOwn) {
  EXPECT_THAT(fault_of([](Config& c) {
                c.device = "";
                c.threads = -1;
                c.quality = static_cast<Quality>(9);
              }),
              AllOf(HasSubstr("Config.threads"), HasSubstr("\nConfig.quality"),
                    HasSubstr("\nConfig.device")));
}

}  // namespace
}  // namespace flowdlo::estimator
