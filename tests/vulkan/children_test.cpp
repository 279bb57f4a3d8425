#include "vulkan/children.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include "frame/temporary_folder.hpp"

namespace flowdlo::vulkan {
namespace {

using ::testing::HasSubstr;
using Kind = Ending::Kind;

std::vector<Ending> shells(const std::vector<std::string>& scripts, int limit_ms = 20000) {
  std::vector<Child> children;
  for (const std::string& script : scripts) {
    children.push_back({.arguments = {"-c", script}, .environment = {"PATH=/usr/bin:/bin"}});
  }
  return run_children("/bin/sh", children, limit_ms);
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Children, AreTakenForWhatTheyDid) {
  const auto endings =
      shells({"echo one >&3; echo done >&3", "echo two >&3; kill -SEGV $$",
              "echo three >&3; exit 7", "exit 127", "echo undone >&3", "echo done >&3; exit 1"});
  ASSERT_EQ(endings.size(), 6U);
  EXPECT_EQ(endings[0].kind, Kind::kDone);
  EXPECT_EQ(endings[0].said, "one\ndone\n");
  EXPECT_EQ(endings[1].kind, Kind::kDied);
  EXPECT_EQ(endings[1].how, "SIGSEGV");
  EXPECT_EQ(endings[1].said, "two\n");
  EXPECT_EQ(endings[2].kind, Kind::kDied);
  EXPECT_EQ(endings[2].how, "exit status 7");
  EXPECT_EQ(endings[3].kind, Kind::kNotStarted);
  EXPECT_EQ(endings[4].kind, Kind::kDied) << "a line that ends in the word is not the word";
  EXPECT_EQ(endings[5].kind, Kind::kDone);
}

TEST(Children, ThatAreLateAreEndedWithAllThatTheyStarted) {
  const test::TemporaryFolder scratch;
  const auto trace = (scratch.path() / "trace").string();
  std::vector<Ending> endings;
  const double took_s = seconds_of([&] {
    endings = shells({"(sleep 2; echo late > " + trace + ") & echo begun >&3; wait",
                      "exec 3>&-; sleep 60", "echo done >&3"},
                     600);
  });
  EXPECT_EQ(endings[0].kind, Kind::kLate);
  EXPECT_EQ(endings[0].said, "begun\n");
  EXPECT_EQ(endings[1].kind, Kind::kLate) << "whoever hangs up is not done";
  EXPECT_EQ(endings[2].kind, Kind::kDone);
  EXPECT_GE(took_s, 0.6);
  EXPECT_LT(took_s, 10) << "nothing is waited for after that";
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  EXPECT_FALSE(std::filesystem::exists(trace)) << "its own child went on without it";
}

TEST(Children, HaveTheirTimeAnewWithEachLine) {
  const auto endings = shells({"for i in 1 2 3 4 5; do echo $i >&3; sleep 0.3; done; echo done >&3",
                               "echo 1 >&3; sleep 60"},
                              900);
  EXPECT_EQ(endings[0].kind, Kind::kDone) << endings[0].said;
  EXPECT_EQ(endings[1].kind, Kind::kLate);
}

TEST(Children, ThatLeaveAProcessBehindAreDoneWhenTheySaySo) {
  std::vector<Ending> endings;
  EXPECT_LT(seconds_of([&] { endings = shells({"sleep 30 & echo done >&3"}); }), 10);
  EXPECT_EQ(endings[0].kind, Kind::kDone);
}

TEST(Children, AnswerToAHostThatReapsThemItself) {
  struct sigaction before {};
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  ASSERT_EQ(::sigaction(SIGCHLD, &ignored, &before), 0);
  const auto endings = shells({"echo a >&3; echo done >&3", "echo a >&3; kill -9 $$"});
  ASSERT_EQ(::sigaction(SIGCHLD, &before, nullptr), 0);
  EXPECT_EQ(endings[0].kind, Kind::kDone);
  EXPECT_EQ(endings[1].kind, Kind::kDied);
  EXPECT_EQ(endings[1].how, "an unknown status");
}

TEST(Children, LeaveNoProcessBehind) {
  (void)shells({"echo done >&3", "exit 3"});
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Children, GetTheirEnvironmentAndNoneOfOurFiles) {
  const auto endings =
      shells({"env | grep -v -e '^PWD=' -e '^_=' -e '^SHLVL=' >&3; ls /proc/self/fd | wc -l >&3; "
              "echo done >&3"});
  EXPECT_EQ(endings[0].said, "PATH=/usr/bin:/bin\n5\ndone\n") << "0 to 3, and that of ls";
}

TEST(Children, OfAProgramThatIsNotThereDoNotStart) {
  const auto endings = run_children("/no/such/program", std::vector<Child>(1), 1000);
  EXPECT_EQ(endings[0].kind, Kind::kNotStarted);
  EXPECT_THAT(endings[0].how, HasSubstr("No such file"));
}

}  // namespace
}  // namespace flowdlo::vulkan
