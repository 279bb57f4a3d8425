#include "vulkan/verdict_memory.hpp"

#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"

namespace flowdlo::vulkan {
namespace {

namespace fs = std::filesystem;
using Kind = Verdict::Kind;

constexpr std::int64_t kNoon = 1'700'000'000;
const DriverKey kKey{.text = "a.json 12 3.4\nlibvulkan_a.so", .names_library = true};
const Verdict kFine{.kind = Kind::kFine,
                    .devices = 2,
                    .words = "fine, 2 devices",
                    .at = kNoon,
                    .of_this_process = true};
const Verdict kBad{.kind = Kind::kCrashed,
                   .devices = 0,
                   .words = "crashed: SIGSEGV",
                   .at = kNoon,
                   .of_this_process = true};

class VerdictMemory : public ::testing::Test {
 protected:
  void SetUp() override { forget_all(); }
  void TearDown() override { forget_all(); }

  [[nodiscard]] fs::path folder() const { return scratch_.path() / "new" / "cache"; }
  [[nodiscard]] fs::path only_file() const { return fs::directory_iterator(folder())->path(); }

 private:
  test::TemporaryFolder scratch_;
};

TEST_F(VerdictMemory, KeepsWhatItWasToldForTheNextProcess) {
  EXPECT_FALSE(recall(kKey, folder(), kNoon));
  remember(kKey, kFine, folder());
  forget_all();
  const auto recalled = recall(kKey, folder(), kNoon + 1000 * kShortMemory_s);
  ASSERT_TRUE(recalled);
  EXPECT_EQ(recalled->kind, Kind::kFine);
  EXPECT_EQ(recalled->devices, 2);
  EXPECT_EQ(recalled->words, "fine, 2 devices");
  EXPECT_FALSE(recalled->of_this_process);
}

TEST_F(VerdictMemory, WithoutAFolderLastsAsLongAsTheProcess) {
  remember(kKey, kFine, {});
  EXPECT_TRUE(recall(kKey, {}, kNoon));
  forget_all();
  EXPECT_FALSE(recall(kKey, {}, kNoon));
}

TEST_F(VerdictMemory, AsksABadDriverAgainAfterADay) {
  remember(kKey, kBad, folder());
  for (const bool anew : {false, true}) {
    if (anew) forget_all();
    EXPECT_TRUE(recall(kKey, folder(), kNoon));
    EXPECT_TRUE(recall(kKey, folder(), kNoon + kShortMemory_s - 1));
    EXPECT_FALSE(recall(kKey, folder(), kNoon + kShortMemory_s));
    EXPECT_FALSE(recall(kKey, folder(), kNoon - 1)) << "the clock was set back";
  }
}

TEST_F(VerdictMemory, AsksAFineDriverOfAnUnknownLibraryAgainAfterADay) {
  const DriverKey vague{.text = kKey.text, .names_library = false};
  remember(vague, kFine, folder());
  EXPECT_TRUE(recall(vague, folder(), kNoon + 1));
  EXPECT_FALSE(recall(vague, folder(), kNoon + kShortMemory_s));
}

TEST_F(VerdictMemory, IsOfOneKeyAlone) {
  remember(kKey, kFine, folder());
  forget_all();
  const DriverKey other{.text = kKey.text + "5", .names_library = true};
  EXPECT_FALSE(recall(other, folder(), kNoon));
}

TEST_F(VerdictMemory, TakesNothingFromADamagedFile) {
  remember(kKey, kBad, folder());
  const std::string whole = test::read_text(only_file());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    forget_all();
    test::write_text(only_file(), whole.substr(0, length));
    EXPECT_FALSE(recall(kKey, folder(), kNoon)) << length;
  }
  forget_all();
  test::write_text(only_file(), whole + "more");
  EXPECT_FALSE(recall(kKey, folder(), kNoon));
  test::write_text(only_file(), whole);
  EXPECT_TRUE(recall(kKey, folder(), kNoon));
}

TEST_F(VerdictMemory, DoesWithoutAFolderThatCannotBe) {
  remember(kKey, kFine, "/dev/null/cache");
  forget_all();
  EXPECT_FALSE(recall(kKey, "/dev/null/cache", kNoon));
}

}  // namespace
}  // namespace flowdlo::vulkan
