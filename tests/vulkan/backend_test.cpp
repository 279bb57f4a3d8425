#include "vulkan/backend.hpp"

#include <algorithm>
#include <cctype>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

TEST(Survey, NamesTheLoaderAndDescribesEveryDevice) {
  const Survey all = survey();
  EXPECT_FALSE(all.loader.empty());
  for (const DeviceReport& device : all.devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.driver.empty());
    EXPECT_FALSE(device.self_test_run);
    if (device.lacks.empty()) {
      EXPECT_EQ(device.uuid.size(), 32U);
      EXPECT_GE(device.subgroup_size, 4);
    }
  }
}

TEST(OpenDevice, FindsADeviceByPartOfItsNameInAnyCase) {
  FLOWDLO_NEEDS_DEVICE();
  std::string part = report(*devices().front()).name.substr(1, 5);
  std::transform(part.begin(), part.end(), part.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto device = open_device({.wanted = part});
  ASSERT_TRUE(device) << device.error().message;
}

TEST(OpenDevice, FindsADeviceByItsUuidWithOrWithoutDashes) {
  FLOWDLO_NEEDS_DEVICE();
  std::string uuid = report(*devices().front()).uuid;
  ASSERT_TRUE(open_device({.wanted = uuid}));
  for (const std::size_t at : {8U, 13U, 18U, 23U}) uuid.insert(at, 1, '-');
  const auto device = open_device({.wanted = uuid});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ(report(**device).uuid, report(*devices().front()).uuid);
}

TEST(OpenDevice, PassesOverCpuDriversWhereToldTo) {
  FLOWDLO_NEEDS_DEVICE();
  const auto device = open_device({.wanted = "vulkan", .allow_cpu_driver = false});
  if (device) {
    EXPECT_NE(report(**device).kind, DeviceKind::kCpu);
  } else {
    EXPECT_EQ(device.error().code, ErrorCode::kNoDevice);
    EXPECT_NE(device.error().message.find("is a CPU driver"), std::string::npos)
        << device.error().message;
  }
}

TEST(OpenDevice, NamesEveryDeviceWhereNoneFits) {
  FLOWDLO_NEEDS_DEVICE();
  const auto device = open_device({.wanted = "no such device"});
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code, ErrorCode::kNoDevice);
  EXPECT_EQ(device.error().message.rfind("no usable Vulkan device: ", 0), 0U);
  for (const auto& known : devices()) {
    EXPECT_NE(device.error().message.find("\"" + report(*known).name + "\""), std::string::npos)
        << device.error().message;
  }
}

TEST(OpenDevice, TwiceGivesTwoDevicesThatWorkSideBySide) {
  FLOWDLO_NEEDS_DEVICE();
  const std::string uuid = report(*devices().front()).uuid;
  const auto other = open_device({.wanted = uuid});
  ASSERT_TRUE(other);
  const Record record = [](Trial& trial) {
    const auto x = trial.input(64, 4, noise(256, 1));
    const auto norm = trial.input(1, 4, {0, 0, 0, 2});
    trial->record(ops::Normalize{.points = x, .norm = norm, .out = trial.output(64, 4)});
  };
  EXPECT_EQ(run_on(*other, record), run_on(devices().front(), record));
  EXPECT_EQ(submit_count(**other), 2U);  // build and run, on its own count
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
