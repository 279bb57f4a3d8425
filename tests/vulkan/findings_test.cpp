// What was measured of a device is measured once: in this process, and where there is a folder in
// the next one.
#include "vulkan/findings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "vulkan/backend.hpp"
#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr std::string_view kKind = "question";
const std::vector<char> kOne{'o', 'n', 'e'};
const std::vector<char> kOther{'o', 't', 'h', 'e', 'r'};

class Findings : public ::testing::Test {
 protected:
  Findings() { forget_findings(); }
  ~Findings() override { forget_findings(); }

  [[nodiscard]] std::filesystem::path folder() const { return folder_.path() / "cache"; }

  test::TemporaryFolder folder_;
};

TEST_F(Findings, TheFirstHoldsForAll) {
  FLOWDLO_NEEDS_DEVICE();
  const Device& device = *devices().front();
  EXPECT_TRUE(known(device, {}, kKind).empty());
  EXPECT_EQ(settle(device, {}, kKind, kOne), kOne);
  EXPECT_EQ(settle(device, {}, kKind, kOther), kOne);
  EXPECT_EQ(known(device, {}, kKind), kOne);
  EXPECT_TRUE(known(device, {}, "another").empty());
}

TEST_F(Findings, HoldForTheNextProcessWhereThereIsAFolder) {
  FLOWDLO_NEEDS_DEVICE();
  const Device& device = *devices().front();
  EXPECT_EQ(settle(device, folder(), kKind, kOne), kOne);
  forget_findings();
  EXPECT_EQ(known(device, folder(), kKind), kOne);
  EXPECT_TRUE(known(device, {}, kKind).empty()) << "without that folder there was none";
}

TEST_F(Findings, AreOneForThreadsThatFindDifferentThings) {
  FLOWDLO_NEEDS_DEVICE();
  const Device& device = *devices().front();
  std::vector<std::vector<char>> told(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < told.size(); ++i) {
    threads.emplace_back([&, i] {
      told[i] = settle(device, folder(), kKind, {static_cast<char>('a' + static_cast<int>(i))});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& one : told) EXPECT_EQ(one, told.front());
  forget_findings();
  EXPECT_EQ(known(device, folder(), kKind), told.front());
}

TEST_F(Findings, OfAQuestionThatFailedAreAskedForAgain) {
  FLOWDLO_NEEDS_DEVICE();
  const Device& device = *devices().front();
  int asked = 0;
  const auto ask = [&](const Result<bool>& answer) {
    return settled(device, {}, kKind, [&] {
      ++asked;
      return answer;
    });
  };
  const auto failed = ask(Error{ErrorCode::kDeviceLost, "it is gone"});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "it is gone");
  for (const bool answer : {true, false}) {
    const auto got = ask(answer);
    ASSERT_TRUE(got);
    EXPECT_TRUE(*got) << "the first answer holds";
  }
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
