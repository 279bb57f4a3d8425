#include "vulkan/children.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace flowdlo::vulkan {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kVoice = 3;                     // the descriptor that a child speaks through
constexpr std::size_t kMostSaid = 1U << 16U;  // bytes
/// A process that a driver keeps within the kernel cannot be ended: it is left to the system.
constexpr milliseconds kFuneral{2000};

std::string name_of_signal(int number) {
  switch (number) {
    case SIGABRT:
      return "SIGABRT";
    case SIGALRM:
      return "SIGALRM";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    case SIGILL:
      return "SIGILL";
    case SIGKILL:
      return "SIGKILL";
    case SIGSEGV:
      return "SIGSEGV";
    case SIGSYS:
      return "SIGSYS";
    case SIGTRAP:
      return "SIGTRAP";
    default:
      return fmt::format("signal {}", number);
  }
}

/// What a child is started with.
class Start {
 public:
  explicit Start(int voice) {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    for (const int standard : {0, 1, 2}) {
      posix_spawn_file_actions_addopen(&files_, standard, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&files_, voice, kVoice);
#if defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 34)
    posix_spawn_file_actions_addclosefrom_np(&files_, kVoice + 1);
#endif
#endif
    sigset_t all;
    sigfillset(&all);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);  // a group of its own, to be ended as a whole
    posix_spawnattr_setflags(
        &attributes_,
        static_cast<short>(POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
  }
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;
  ~Start() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }

  int run(const std::filesystem::path& program, const Child& child, pid_t& process) const {
    const std::string name = program.string();
    const auto pointers = [](const std::vector<std::string>& texts, const std::string* first) {
      std::vector<char*> result;
      if (first != nullptr) result.push_back(const_cast<char*>(first->c_str()));
      for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
      result.push_back(nullptr);
      return result;
    };
    const auto arguments = pointers(child.arguments, &name);
    const auto environment = pointers(child.environment, nullptr);
    return posix_spawn(&process, name.c_str(), &files_, &attributes_, arguments.data(),
                       environment.data());
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

struct Closing {
  int descriptor;
  ~Closing() { ::close(descriptor); }
};

/// One child from its start to its end. Whatever happens to us, it does not outlive us here.
class Process {
 public:
  /// What throws in here is cleaned up: the first constructor has made a whole object by then.
  Process(const std::filesystem::path& program, const Child& child, milliseconds limit)
      : Process(limit) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
      ending_.how = std::generic_category().message(errno);
      return;
    }
    ear_ = ends[0];
    const Closing mouth{ends[1]};
    const int problem = Start(ends[1]).run(program, child, process_);
    if (problem == 0) return;
    process_ = 0;
    hang_up();
    ending_.how = std::generic_category().message(problem);
  }
  Process(Process&& other) noexcept
      : limit_(other.limit_),
        by_(other.by_),
        process_(std::exchange(other.process_, 0)),
        ear_(std::exchange(other.ear_, -1)),
        ending_(std::move(other.ending_)) {}
  Process& operator=(Process&&) = delete;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    end();
    hang_up();
  }

  [[nodiscard]] bool speaks() const { return ear_ >= 0; }
  [[nodiscard]] int ear() const { return ear_; }
  /// When it will have been silent for too long.
  [[nodiscard]] Clock::time_point by() const { return by_; }

  /// What has come. Nothing more will where it is done, or has closed its end.
  void listen() {
    std::array<char, 4096> bytes{};
    while (ear_ >= 0) {
      const auto count = ::read(ear_, bytes.data(), bytes.size());
      if (count > 0) {
        by_ = Clock::now() + limit_;
        if (ending_.said.size() < kMostSaid) {
          ending_.said.append(bytes.data(), static_cast<std::size_t>(count));
        }
        continue;
      }
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) break;
      hang_up();
    }
    if (done()) hang_up();
  }

  /// Too long silent: its time is over.
  void give_up() {
    late_ = true;
    end();
    hang_up();
  }

  /// Its ending, once it speaks no more.
  Ending conclude() {
    using Kind = Ending::Kind;
    const bool late = late_ || !wait_until(by_);
    end();
    if (done() && !late) {
      ending_.kind = Kind::kDone;
    } else if (late) {
      ending_.kind = Kind::kLate;
    } else {
      ending_.kind = ending_.said.empty() ? Kind::kNotStarted : Kind::kDied;
    }
    return std::move(ending_);
  }

 private:
  explicit Process(milliseconds limit) : limit_(limit), by_(Clock::now() + limit) {}

  [[nodiscard]] bool done() const {
    const std::string_view said = ending_.said;
    return said == "done\n" || said.ends_with("\ndone\n");
  }

  void hang_up() {
    if (ear_ >= 0) ::close(std::exchange(ear_, -1));
  }

  /// True when it is no more. Its status may have gone to a wait of the host's own.
  bool gone() {
    if (process_ == 0) return true;
    int status = 0;
    const pid_t who = ::waitpid(process_, &status, WNOHANG);
    if (who == 0 || (who < 0 && errno == EINTR)) return false;
    process_ = 0;
    if (who < 0) {
      ending_.how = "an unknown status";
    } else if (WIFSIGNALED(status)) {
      ending_.how = name_of_signal(WTERMSIG(status));
    } else {
      ending_.how = fmt::format("exit status {}", WEXITSTATUS(status));
    }
    return true;
  }

  bool wait_until(Clock::time_point by) {
    constexpr milliseconds kTurn{1};
    while (!gone()) {
      if (Clock::now() >= by) return false;
      std::this_thread::sleep_for(kTurn);
    }
    return true;
  }

  void end() {
    if (process_ == 0 || gone()) return;
    ::kill(-process_, SIGKILL);
    ::kill(process_, SIGKILL);  // where it had not come to its group yet
    (void)wait_until(Clock::now() + kFuneral);
  }

  milliseconds limit_;
  Clock::time_point by_;
  bool late_ = false;
  pid_t process_ = 0;  // 0: none
  int ear_ = -1;
  Ending ending_;
};

}  // namespace

std::vector<Ending> run_children(const std::filesystem::path& program,
                                 std::span<const Child> children, int limit_ms) {
  std::vector<Process> processes;
  processes.reserve(children.size());
  for (const Child& child : children) {
    processes.emplace_back(program, child, milliseconds(limit_ms));
  }
  std::vector<pollfd> ears;
  for (;;) {
    ears.clear();
    auto first = Clock::time_point::max();
    for (Process& process : processes) {
      if (process.speaks() && process.by() <= Clock::now()) process.give_up();
      if (!process.speaks()) continue;
      ears.push_back({process.ear(), POLLIN, 0});
      first = std::min(first, process.by());
    }
    if (ears.empty()) break;
    const auto left = std::chrono::ceil<milliseconds>(first - Clock::now()).count();
    (void)::poll(ears.data(), ears.size(), static_cast<int>(std::max<decltype(left)>(left, 1)));
    for (Process& process : processes) process.listen();
  }
  std::vector<Ending> endings;
  endings.reserve(processes.size());
  for (Process& process : processes) endings.push_back(process.conclude());
  return endings;
}

}  // namespace flowdlo::vulkan
