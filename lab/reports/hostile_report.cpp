// flowdlo-lab hostile-report: what each mask of the hostile corpus takes of processor and memory,
// in the library and in the command, as one Markdown table.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/App.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/frame_folder.hpp"
#include "hostile/cost.hpp"
#include "hostile/hostile_frame.hpp"
#include "hostile/hostile_mask.hpp"

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string only;
  bool here = false;
  bool fast = false;
  bool ropes = false;
  fs::path weights;
  fs::path command;
  fs::path scratch = fs::temp_directory_path() / "flowdlo_hostile";
  int rounds = 1;
  int limit_s = 120;
};

/// What a program wrote, and what it took.
struct Run {
  int status = -1;  // -1: killed, for example at its limit
  double cpu_s = 0;
  double peak_mb = 0;
  std::string output;
};

Run run(std::vector<std::string> arguments, int limit_s) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    const rlimit limit{static_cast<rlim_t>(limit_s), static_cast<rlim_t>(limit_s)};
    ::setrlimit(RLIMIT_CPU, &limit);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    ::execvp(words[0], words.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  Run result;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; (count = ::read(ends[0], buffer.data(), buffer.size())) > 0;) {
    result.output.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.peak_mb = static_cast<double>(usage.ru_maxrss) * 1024 / 1.0e6;
  return result;
}

FrameFolder frame_of(const HostileMask& mask) { return frame_around(draw(mask), mask.name()); }

/// `--here`: measures masks in this process, and an ordinary frame of their size before each size.
int measure(const Options& options, const std::vector<HostileMask>& masks) {
  const auto quality = options.fast ? Quality::kFast : Quality::kFull;
  auto estimator = Estimator::create({.weights = options.weights,
                                      .device = "cpu",
                                      .quality = quality,
                                      .ropes = options.ropes ? 0 : 1,
                                      .threads = 1});
  if (!estimator) {
    fmt::print(stderr, "{}\n", estimator.error().message);
    return 1;
  }
  cv::Size size_px;
  double ordinary_s = 0;
  for (const HostileMask& mask : masks) {
    if (mask.size_px != size_px) {
      size_px = mask.size_px;
      const auto ordinary = frame_around(draw_ordinary(size_px), "ordinary");
      ordinary_s = cost_of(ordinary.frame(), *estimator, 1 + options.rounds).cpu_s;
    }
    const Cost cost = cost_of(frame_of(mask).frame(), *estimator, options.rounds,
                              options.ropes ? Asked::kSeveralRopes : Asked::kOneRope);
    fmt::print("| {} | {:.3f} | {:.2f} | {:.0f} | {} |\n", mask.name(), cost.cpu_s,
               cost.cpu_s / ordinary_s, cost.peak_mb, cost.verdict);
    std::fflush(stdout);
  }
  return 0;
}

/// What the library's process and the command are told alike.
void add_model(const Options& options, std::vector<std::string>& line) {
  if (!options.weights.empty()) line.insert(line.end(), {"--weights", options.weights});
  if (options.fast) line.insert(line.end(), {"--quality", "fast"});
}

/// The mask's frame through the command, on one thread.
std::string command_cells(const Options& options, const HostileMask& mask) {
  if (options.command.empty()) return "";
  const fs::path folder = options.scratch / mask.name();
  const auto frame = frame_of(mask);
  const auto saved = save_frame_folder(folder, frame.frame(), 0.001);
  if (!saved) return saved.error().message;
  std::vector<std::string> line{
      options.command, "estimate", folder,      "--out", options.scratch / "out",
      "--device",      "cpu",      "--threads", "1",     "--quiet"};
  add_model(options, line);
  const Run took = run(std::move(line), options.limit_s);
  std::error_code ignored;
  fs::remove_all(options.scratch, ignored);
  if (took.status < 0) return fmt::format(" > {} | {:.0f} |", options.limit_s, took.peak_mb);
  return fmt::format(" {:.2f} | {:.0f} |", took.cpu_s, took.peak_mb);
}

/// Each mask in a process of its own, so that no peak is another one's, and one that is stopped
/// stops nothing else.
int report(const Options& options, const std::vector<HostileMask>& masks) {
  fmt::print("| mask | library, CPU s | times an ordinary frame | library, peak MB | verdict |{}\n",
             options.command.empty() ? "" : " command, CPU s | command, peak MB |");
  fmt::print("|---|---|---|---|---|{}\n", options.command.empty() ? "" : "---|---|");
  for (const HostileMask& mask : masks) {
    std::vector<std::string> line{"/proc/self/exe",
                                  "hostile-report",
                                  "--here",
                                  "--only",
                                  mask.name(),
                                  "--rounds",
                                  std::to_string(options.rounds)};
    if (options.ropes) line.emplace_back("--ropes");
    add_model(options, line);
    Run took = run(std::move(line), options.limit_s);
    if (took.status != 0) {
      took.output = fmt::format("| {} | > {} | | {:.0f} | stopped |\n", mask.name(),
                                options.limit_s, took.peak_mb);
    }
    took.output.pop_back();
    fmt::print("{}{}\n", took.output, command_cells(options, mask));
    std::fflush(stdout);
  }
  return 0;
}

int run(const Options& options) {
  auto masks = hostile_corpus();
  std::erase_if(masks, [&](const HostileMask& mask) {
    return mask.name().find(options.only) == std::string::npos;
  });
  return options.here ? measure(options, masks) : report(options, masks);
}

}  // namespace

void add_hostile_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app =
      *support::add_command(program, "hostile-report",
                            "What each mask of the hostile corpus takes of processor and memory");
  app.add_option("--only", options->only, "Masks whose name holds this");
  app.add_flag("--here", options->here, "Measure in this process, without the table's head");
  app.add_flag("--ropes", options->ropes, "Any number of ropes, in the library");
  app.add_option("--weights", options->weights)->check(CLI::ExistingFile);
  app.add_option_function<std::string>(
         "--quality", [options](const std::string& quality) { options->fast = quality == "fast"; },
         "As flowdlo has it")
      ->check(CLI::IsMember({"full", "fast"}));
  app.add_option("--command", options->command, "Measure this flowdlo as well")
      ->check(CLI::ExistingFile);
  app.add_option("--scratch", options->scratch, "Frames are written below it");
  app.add_option("--rounds", options->rounds, "The least of so many counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--limit", options->limit_s, "CPU seconds after which a run is stopped")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
