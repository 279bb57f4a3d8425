// Drivers that crash or hang, beside one that works.
#include "vulkan/probe.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "frame/temporary_folder.hpp"
#include "support/variable.hpp"
#include "vulkan/driver_manifests.hpp"
#include "vulkan/every_op.hpp"
#include "vulkan/loader.hpp"
#include "vulkan/verdict_memory.hpp"

namespace flowdlo::vulkan::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr int kPatience_ms = 20000;  // for a driver that works, on a busy machine
constexpr int kShort_ms = 700;       // for one that sleeps for ever

std::string with_colons(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ":") + part;
  return text;
}

class Probe : public ::testing::Test {
 protected:
  void SetUp() override { forget_all(); }
  void TearDown() override { forget_all(); }

  [[nodiscard]] Probing probing(int limit_ms = kPatience_ms) const {
    return {.on = true, .memory = scratch_.path() / "cache", .limit_ms = limit_ms};
  }
  /// How often a false driver was loaded, whoever did it.
  [[nodiscard]] std::size_t loads() const {
    return fs::exists(log_) ? test::read_text(log_).size() : 0;
  }

  test::TemporaryFolder scratch_;
  fs::path log_ = scratch_.path() / "loads";
  test::Variable logged_{"FALSE_DRIVER_LOG", log_.string()};
};

TEST_F(Probe, FindsItsProgramInTheBuildTree) {
  const auto program = probe_program();
  ASSERT_FALSE(program.empty());
  EXPECT_THAT(program.string(), HasSubstr("libexec/flowdlo/flowdlo-probe-"));
}

TEST_F(Probe, SaysOfEachDriverWhatItDidAndOutlivesIt) {
  const test::Drivers drivers(with_colons({FLOWDLO_DRIVER_THAT_ABORTS, FLOWDLO_DRIVER_THAT_EXITS}));
  const Probed probed = probe(probing(), "1.3");
  EXPECT_THAT(probed.unseen, IsEmpty());
  ASSERT_EQ(probed.drivers.size(), 2U);
  EXPECT_EQ(probed.drivers[0].manifest, FLOWDLO_DRIVER_THAT_ABORTS);
  EXPECT_FALSE(probed.drivers[0].used);
  EXPECT_EQ(probed.drivers[0].verdict,
            "crashed: ended its process by SIGABRT when FlowDLO listed its devices");
  EXPECT_FALSE(probed.drivers[1].used);
  EXPECT_EQ(probed.drivers[1].verdict,
            "crashed: ended its process by exit status 0 when FlowDLO listed its devices");
  EXPECT_EQ(loads(), 2U);
}

TEST_F(Probe, GivesADriverNoMoreThanItsTime) {
  const test::Drivers drivers(FLOWDLO_DRIVER_THAT_SLEEPS);
  const auto start = std::chrono::steady_clock::now();
  const Probed probed = probe(probing(kShort_ms), "1.3");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(probed.drivers.size(), 1U);
  EXPECT_FALSE(probed.drivers[0].used);
  EXPECT_THAT(probed.drivers[0].verdict, StartsWith("hung: not back after 0.7 s when "));
  EXPECT_GE(took.count(), kShort_ms / 1e3);
  EXPECT_LT(took.count(), 10);
}

TEST_F(Probe, AsksOnceAndRemembersAcrossProcesses) {
  const test::Drivers drivers(FLOWDLO_DRIVER_THAT_ABORTS);
  const Probed first = probe(probing(), "1.3");
  EXPECT_FALSE(first.drivers.at(0).remembered);
  const Probed second = probe(probing(), "1.3");
  EXPECT_FALSE(second.drivers.at(0).remembered);
  EXPECT_EQ(loads(), 1U);
  forget_all();  // as a new process has
  const Probed third = probe(probing(), "1.3");
  EXPECT_TRUE(third.drivers.at(0).remembered);
  EXPECT_EQ(third.drivers[0].verdict, first.drivers[0].verdict);
  EXPECT_FALSE(third.drivers[0].used);
  EXPECT_EQ(loads(), 1U);
  (void)probe(probing(), "1.4");  // another loader
  EXPECT_EQ(loads(), 2U);
  const test::Variable told("RADV_DEBUG", "nocache");  // drivers are told something else
  (void)probe(probing(), "1.3");
  EXPECT_EQ(loads(), 3U);
}

TEST_F(Probe, AsksAgainWhatWasInstalledAnew) {
  const fs::path manifest = scratch_.path() / "driver.json";
  fs::copy_file(FLOWDLO_DRIVER_THAT_ABORTS, manifest);
  const test::Drivers drivers(manifest.string());
  (void)probe(probing(), "1.3");
  EXPECT_EQ(loads(), 1U);
  fs::last_write_time(manifest, fs::last_write_time(manifest) + std::chrono::seconds(1));
  EXPECT_FALSE(probe(probing(), "1.3").drivers.at(0).remembered);
  EXPECT_EQ(loads(), 2U);
}

TEST_F(Probe, LeavesDriversUnseenWhereItIsOffOrItsProgramIsMissing) {
  const test::Drivers drivers(FLOWDLO_DRIVER_THAT_ABORTS);
  Probing off = probing();
  off.on = false;
  EXPECT_EQ(probe(off, "1.3").unseen, "Config::probe is off");
  EXPECT_THAT(probe(off, "1.3").drivers, IsEmpty());
  Probing astray = probing();
  astray.program = scratch_.path() / "no-such-program";
  const Probed unseen = probe(astray, "1.3");
  EXPECT_THAT(unseen.unseen, AllOf(HasSubstr("did not start"), HasSubstr("No such file")));
  EXPECT_FALSE(unseen.any_bad());
  EXPECT_EQ(loads(), 0U);
  EXPECT_FALSE(probe(probing(), "1.3").drivers.at(0).remembered) << "nothing was found out";
}

/// A driver that works, as a path of its manifest.
std::string good_driver() {
  for (const fs::path& manifest : driver_manifests(std::getenv)) {
    forget_all();
    const test::Drivers alone(manifest.string());
    for (const DeviceReport& device : survey({.on = false}).devices) {
      if (device.lacks.empty()) return manifest.string();
    }
  }
  return {};
}

TEST_F(Probe, LetsTheOthersWorkWithTheSameBits) {
  FLOWDLO_NEEDS_DEVICE();
  const std::string good = good_driver();
  ASSERT_FALSE(good.empty());
  const Record record = [](Trial& trial) { record_every_op(trial); };
  const auto run = [&](const Probing& how) {
    auto device = open_device({.wanted = "vulkan", .probing = how});
    EXPECT_TRUE(device) << device.error().message;
    return device ? run_on(*device, record) : Outputs{};
  };
  Outputs expected;
  {
    const test::Drivers alone(good);
    expected = run(probing());
    ASSERT_FALSE(expected.empty());
  }
  // The one that sleeps alone gets little time: a verdict of the others is remembered.
  {
    const test::Drivers bad(FLOWDLO_DRIVER_THAT_SLEEPS);
    (void)probe(probing(kShort_ms), (*Loader::open())->version());
  }
  const test::Drivers all(
      with_colons({FLOWDLO_DRIVER_THAT_ABORTS, good, FLOWDLO_DRIVER_THAT_SLEEPS}));
  const Survey seen = survey(probing());
  EXPECT_EQ(seen.probed.drivers.size(), 3U);
  EXPECT_TRUE(seen.probed.any_bad());
  EXPECT_THAT(seen.advice, IsEmpty());
  EXPECT_EQ(run(probing()), expected);
  EXPECT_EQ(loads(), 2U) << "each bad driver was loaded once, and not by this process";
  EXPECT_EQ(open_device({.wanted = "no such device", .probing = probing()}).error().code,
            ErrorCode::kNoDevice);
}

TEST_F(Probe, SaysWhyWhereOnlyBadDriversAreThere) {
  const test::Drivers drivers(FLOWDLO_DRIVER_THAT_ABORTS);
  const auto device = open_device({.wanted = "vulkan", .probing = probing()});
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code, ErrorCode::kNoDevice);
  EXPECT_THAT(device.error().message,
              AllOf(HasSubstr(FLOWDLO_DRIVER_THAT_ABORTS), HasSubstr("SIGABRT"),
                    HasSubstr("update or remove them")));
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
