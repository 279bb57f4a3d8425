// A frame folder is all of one frame, whatever call fails and whenever a process ends.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "files/failing_calls.hpp"
#include "frame/frame_folder.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using test::Fault;
using test::TemporaryFolder;
using testing::HasSubstr;

/// A frame of 8 x 6 px whose every file tells its number, its depth scale included.
struct Numbered {
  explicit Numbered(int number, bool optional = true) : scale_m(0.001 * number) {
    const auto value = static_cast<std::uint8_t>(number);
    folder = {"", 8, 6, {100.0F + static_cast<float>(number), 100, 4, 3}, {}, {}, {}, {}};
    folder.depth_m.assign(48, static_cast<float>(number * number) * 0.1F);
    folder.mask.assign(48, value);
    folder.mask[7] = 255;
    if (!optional) return;
    folder.color_bgr.assign(144, value);
    folder.truth.emplace();
    folder.truth->fill({static_cast<float>(number), 0, 1});
  }

  [[nodiscard]] Result<void> save(const fs::path& to, const files::SystemCalls& calls) const {
    return frame::save_folder(to, folder.frame(), scale_m, folder.truth ? &*folder.truth : nullptr,
                              Durability::kSynced, calls);
  }

  [[nodiscard]] bool is(const FrameFolder& other) const {
    if (other.depth_m.size() != folder.depth_m.size()) return false;
    for (std::size_t i = 0; i < folder.depth_m.size(); ++i) {
      if (std::abs(other.depth_m[i] - folder.depth_m[i]) > 1e-4F) return false;
    }
    return other.mask == folder.mask && other.color_bgr == folder.color_bgr &&
           other.truth == folder.truth && other.intrinsics.fx == folder.intrinsics.fx;
  }

  FrameFolder folder;
  double scale_m;
};

const Numbered kOld(2);
const Numbered kNew(3, /*optional=*/false);
const FailingCalls kQuick;  // nothing fails, and nothing waits for the disk

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// Saves kNew over kOld with `fault` at each call in turn, and looks at what is there then.
class InterruptedSave : public testing::TestWithParam<Fault> {
 protected:
  /// Of a save that nothing goes wrong with.
  static int calls_of_a_save() {
    const TemporaryFolder folder;
    EXPECT_TRUE(kOld.save(folder.path(), kQuick));
    const FailingCalls calls;
    EXPECT_TRUE(kNew.save(folder.path(), calls));
    return calls.count();
  }
};

TEST_P(InterruptedSave, LeavesTheOldFrameOrTheNewOne) {
  const int count = calls_of_a_save();
  ASSERT_GT(count, 40);
  int old_frames = 0;
  int new_frames = 0;
  for (int at = 0; at < count; ++at) {
    const TemporaryFolder folder;
    ASSERT_TRUE(kOld.save(folder.path(), kQuick));
    test::write_text(folder.path() / "meta.json", "{}");
    Fault fault = GetParam();
    fault.at = at;
    SCOPED_TRACE(testing::Message() << fault);
    const auto saved = kNew.save(folder.path(), FailingCalls(fault));
    const auto loaded = load_frame_folder(folder.path());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(kOld.is(*loaded) || kNew.is(*loaded)) << "a mixture";
    ++(kOld.is(*loaded) ? old_frames : new_frames);
    if (saved) {
      ASSERT_TRUE(kNew.is(*loaded));
    } else {
      ASSERT_EQ(saved.error().code, ErrorCode::kIo);
      ASSERT_THAT(saved.error().message, HasSubstr(folder.path().filename().string()));
      ASSERT_THAT(saved.error().message, HasSubstr("; "));
    }
    ASSERT_EQ(test::read_text(folder.path() / "meta.json"), "{}");

    // And the folder is as good as ever.
    const auto again = kNew.save(folder.path(), kQuick);
    ASSERT_TRUE(again) << again.error().message;
    const auto reloaded = load_frame_folder(folder.path());
    ASSERT_TRUE(reloaded) << reloaded.error().message;
    ASSERT_TRUE(kNew.is(*reloaded));
    if (fault.kind != Fault::Kind::kKilled) continue;
    ASSERT_FALSE(fs::exists(folder.path() / ".flowdlo-commit"));
  }
  if (GetParam().kind == Fault::Kind::kShort || GetParam().code == EINTR) {
    EXPECT_EQ(old_frames, 0) << "nothing was wrong with these";
  } else {
    EXPECT_GT(old_frames, 0);
    EXPECT_GT(new_frames, 0);
  }
}

TEST_P(InterruptedSave, OfAFirstFrameLeavesItOrARefusedFolder) {
  const TemporaryFolder counted;
  const FailingCalls counting;
  ASSERT_TRUE(kNew.save(counted.path() / "a" / "b", counting));
  for (int at = 0; at < counting.count(); ++at) {
    const TemporaryFolder folder;
    Fault fault = GetParam();
    fault.at = at;
    SCOPED_TRACE(testing::Message() << fault);
    const auto saved = kNew.save(folder.path() / "a" / "b", FailingCalls(fault));
    const auto loaded = load_frame_folder(folder.path() / "a" / "b");
    if (loaded) {
      ASSERT_TRUE(kNew.is(*loaded));
    } else {
      ASSERT_FALSE(saved);
      ASSERT_THAT(loaded.error().message, HasSubstr("expected a f"));  // a folder, a file
    }
  }
}

TEST_P(InterruptedSave, IsReadByCallsThatFailToo) {
  const TemporaryFolder folder;
  ASSERT_TRUE(kOld.save(folder.path(), kQuick));
  const FailingCalls counting;
  ASSERT_TRUE(frame::load_folder(folder.path(), counting));
  for (int at = 0; at < counting.count(); ++at) {
    Fault fault = GetParam();
    fault.at = at;
    SCOPED_TRACE(testing::Message() << fault);
    const auto loaded = frame::load_folder(folder.path(), FailingCalls(fault));
    if (loaded) {
      ASSERT_TRUE(kOld.is(*loaded));
    } else {
      ASSERT_THAT(loaded.error().message, HasSubstr(folder.path().filename().string()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryCall, InterruptedSave, testing::ValuesIn(test::faults_of_a_call()));

TEST(InterruptedSaves, OneAfterAnotherLeaveOneOfTheFrames) {
  const TemporaryFolder folder;
  ASSERT_TRUE(kOld.save(folder.path(), kQuick));
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const Numbered& next = round % 2 == 0 ? kNew : kOld;
    const Fault fault{Fault::Kind::kKilled, EIO, static_cast<int>(random() % 90)};
    (void)next.save(folder.path(), FailingCalls(fault));
    const auto loaded = load_frame_folder(folder.path());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(kOld.is(*loaded) || kNew.is(*loaded)) << fault;
  }
}

TEST(InterruptedSaves, OfADamagedRecordAreRefusedUntilTheFolderIsWrittenAgain) {
  const TemporaryFolder folder;
  ASSERT_TRUE(kOld.save(folder.path(), kQuick));
  test::write_text(folder.path() / ".flowdlo-commit",
                   "flowdlo commit 1\nkey camera.json\nput ../x");
  const auto loaded = load_frame_folder(folder.path());
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(loaded.error().message, HasSubstr("cut off"));
  ASSERT_TRUE(kNew.save(folder.path(), kQuick));
  EXPECT_TRUE(load_frame_folder(folder.path()));
}

TEST(InterruptedSaves, LeaveALinkToTheFolderOne) {
  const TemporaryFolder parent;
  fs::create_directories(parent.path() / "real");
  fs::create_directory_symlink("real", parent.path() / "link");
  ASSERT_TRUE(kOld.save(parent.path() / "link", kQuick));
  ASSERT_TRUE(kNew.save(parent.path() / "link", kQuick));
  EXPECT_TRUE(fs::is_symlink(parent.path() / "link"));
  const auto loaded = load_frame_folder(parent.path() / "real");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(kNew.is(*loaded));
  EXPECT_THAT(names_in(parent.path() / "real"),
              testing::UnorderedElementsAre("camera.json", "depth.png", "mask.png"));
}

TEST(InterruptedSaves, PlantedLinksInTheFolderAreReplacedAndTheirTargetsLeft) {
  const TemporaryFolder parent;
  const auto victim = parent.path() / "victim";
  test::write_text(victim, "precious");
  fs::create_directories(parent.path() / "rope");
  for (const auto& name : frame::kFrameFiles) {
    fs::create_symlink(victim, parent.path() / "rope" / name);
  }
  ASSERT_TRUE(kNew.save(parent.path() / "rope", kQuick));
  EXPECT_EQ(test::read_text(victim), "precious");
  EXPECT_TRUE(load_frame_folder(parent.path() / "rope"));
}

// Writes frames 2 and 3 in turn until it is ended.
[[noreturn]] void write_for_ever(const fs::path& folder, const files::SystemCalls& calls,
                                 int first) {
  for (int round = first;; ++round) (void)(round % 2 == 0 ? kOld : kNew).save(folder, calls);
}

/// A process that writes until it is killed.
class Writer {
 public:
  Writer(const fs::path& folder, const files::SystemCalls& calls, int first) : process_(::fork()) {
    if (process_ == 0) write_for_ever(folder, calls, first);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { kill(); }

  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  pid_t process_;
};

// FLOWDLO_LONG_TESTS=1: the rounds of the long form.
int rounds(int few, int many) { return std::getenv("FLOWDLO_LONG_TESTS") != nullptr ? many : few; }

TEST(KilledWriter, AtAnyMomentLeavesOneOfTheFrames) {
  const TemporaryFolder folder;
  ASSERT_TRUE(kOld.save(folder.path(), kQuick));
  std::mt19937 random(11);
  const int kills = rounds(200, 2000);
  for (int round = 0; round < kills; ++round) {
    {
      Writer writer(folder.path(), round % 8 == 0 ? files::kernel() : kQuick, round);
      ::usleep(1000 + static_cast<unsigned>(random()) % 15000);
      writer.kill();
    }
    const auto loaded = load_frame_folder(folder.path());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(kOld.is(*loaded) || kNew.is(*loaded)) << "round " << round;
  }
}

void expect_whole_frames_beside_two_writers(const files::SystemCalls& calls) {
  const TemporaryFolder folder;
  ASSERT_TRUE(kOld.save(folder.path(), calls));
  Writer one(folder.path(), calls, 0);
  Writer other(folder.path(), calls, 1);
  int seen_old = 0;
  int seen_new = 0;
  const int reads = rounds(1500, 50000);
  for (int read = 0; read < reads; ++read) {
    const auto loaded = load_frame_folder(folder.path());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(kOld.is(*loaded) || kNew.is(*loaded)) << "a mixture";
    ++(kOld.is(*loaded) ? seen_old : seen_new);
  }
  EXPECT_GT(seen_old, 0);
  EXPECT_GT(seen_new, 0);
}

TEST(TwoWriters, AndAReaderSeeWholeFrames) { expect_whole_frames_beside_two_writers(kQuick); }

TEST(TwoWriters, WhereNoFoldersAreLockedSeeWholeFrames) {
  FailingCalls calls;
  calls.without_folder_locks();
  expect_whole_frames_beside_two_writers(calls);
}

}  // namespace
}  // namespace flowdlo
