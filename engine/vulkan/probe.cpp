#include "vulkan/probe.hpp"

#include <fmt/format.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <system_error>

#include "files/own_file.hpp"
#include "files/shown_name.hpp"
#include "flowdlo/version.hpp"
#include "vulkan/children.hpp"
#include "vulkan/driver_manifests.hpp"
#include "vulkan/verdict_memory.hpp"

extern char** environ;  // NOLINT: POSIX names it so

namespace flowdlo::vulkan {
namespace {

namespace fs = std::filesystem;

std::string program_name() {
  return fmt::format("flowdlo-probe-{}.{}", FLOWDLO_VERSION_MAJOR, FLOWDLO_VERSION_MINOR);
}

/// Our environment, in which this manifest is the only one.
std::vector<std::string> environment_for(const fs::path& manifest) {
  std::vector<std::string> variables;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    if (variable.starts_with("VK_DRIVER_FILES=") || variable.starts_with("VK_ICD_FILENAMES=") ||
        variable.starts_with("VK_ADD_DRIVER_FILES=")) {
      continue;
    }
    variables.emplace_back(variable);
  }
  variables.push_back("VK_DRIVER_FILES=" + manifest.string());
  variables.push_back("VK_ICD_FILENAMES=" + manifest.string());  // for loaders before 1.3.207
  return variables;
}

std::string_view last_line(std::string_view text) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  const auto before = text.rfind('\n');
  return before == std::string_view::npos ? text : text.substr(before + 1);
}

/// Of "devices N" among what was said.
int devices_said(std::string_view said) {
  constexpr std::string_view kWord = "devices ";
  const auto at = said.rfind(kWord);
  if (at == std::string_view::npos) return 0;
  int devices = 0;
  const auto* const begin = said.data() + at + kWord.size();
  std::from_chars(begin, said.data() + said.size(), devices);
  return devices;
}

Verdict judged(const Ending& ending, int limit_ms, std::int64_t now) {
  using Kind = Verdict::Kind;
  Verdict verdict;
  verdict.at = now;
  const std::string stage = files::shown(last_line(ending.said));
  if (ending.kind == Ending::Kind::kDone) {
    verdict.devices = devices_said(ending.said);
    verdict.words =
        fmt::format("fine, {} device{}", verdict.devices, verdict.devices == 1 ? "" : "s");
  } else if (ending.kind == Ending::Kind::kLate) {
    verdict.kind = Kind::kHung;
    verdict.words =
        fmt::format("hung: not back after {:.1f} s when {}", limit_ms / 1e3,
                    stage.empty() ? "the probe had not begun" : fmt::format("FlowDLO {}", stage));
  } else {
    verdict.kind = Kind::kCrashed;
    verdict.words =
        fmt::format("crashed: ended its process by {} when FlowDLO {}", ending.how, stage);
  }
  return verdict;
}

DriverReport report_of(const fs::path& manifest, const Verdict& verdict) {
  return {.manifest = manifest,
          .used = verdict.kind == Verdict::Kind::kFine,
          .devices = verdict.devices,
          .verdict = verdict.words,
          .remembered = !verdict.of_this_process};
}

/// Why no driver can be asked; empty where they can.
std::string hindrance(const Probing& probing, const fs::path& program) {
  if (!probing.on) return "Config::probe is off";
  if (::getauxval(AT_SECURE) != 0) {  // a child's loader would not take our word for a manifest
    return "this process has more rights than its user";
  }
  if (program.empty()) {
    return fmt::format("libexec/flowdlo/{} is not beside the library or the program",
                       program_name());
  }
  return {};
}

/// Asks those drivers that nothing is known of; one that cannot be asked is taken as it is.
void ask(const Probing& probing, const fs::path& program, const std::vector<std::size_t>& unknown,
         const std::vector<DriverKey>& keys, std::int64_t now, Probed& probed) {
  constexpr int kMsPerSecond = 1000;
  constexpr int kMostLines = 32;  // of a child, which ends itself at last where we could not
  std::vector<Child> children;
  for (const std::size_t i : unknown) {
    children.push_back(
        {.arguments = {std::to_string(::getpid()),
                       std::to_string(kMostLines * (probing.limit_ms / kMsPerSecond + 1))},
         .environment = environment_for(probed.drivers[i].manifest)});
  }
  const auto endings = run_children(program, children, probing.limit_ms);
  for (std::size_t n = 0; n < unknown.size(); ++n) {
    DriverReport& driver = probed.drivers[unknown[n]];
    if (endings[n].kind == Ending::Kind::kNotStarted) {
      driver.verdict =
          fmt::format("not asked: {} did not start ({})", files::shown(program), endings[n].how);
      probed.unseen = driver.verdict;
      continue;
    }
    const Verdict verdict = judged(endings[n], probing.limit_ms, now);
    remember(keys[unknown[n]], verdict, probing.memory);
    driver = report_of(driver.manifest, verdict);
  }
}

}  // namespace

bool Probed::any_bad() const {
  return std::any_of(drivers.begin(), drivers.end(),
                     [](const DriverReport& driver) { return !driver.used; });
}

std::string Probed::bad() const {
  std::string text;
  for (const DriverReport& driver : drivers) {
    if (driver.used) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", files::shown(driver.manifest),
                        driver.verdict);
  }
  return text;
}

fs::path probe_program() {
  std::error_code error;
  const fs::path program = files::running_program();
  for (const fs::path& own : {files::own_file(program), program}) {
    for (const fs::path& folder : files::folders_around(own)) {
      const fs::path libexec = folder / "libexec";
      const fs::path ours = libexec / "flowdlo";
      const fs::path candidate = ours / program_name();
      if (!fs::is_regular_file(candidate, error)) continue;
      const std::array way = {folder, libexec, ours, candidate};
      if (std::none_of(way.begin(), way.end(), files::anybody_writes)) return candidate;
    }
  }
  return {};
}

Probed probe(const Probing& probing, const std::string& loader) {
  Probed probed;
  const fs::path program = probing.program.empty() ? probe_program() : probing.program;
  probed.unseen = hindrance(probing, program);
  if (!probed.unseen.empty()) return probed;
  const auto now = static_cast<std::int64_t>(std::time(nullptr));
  std::vector<DriverKey> keys;
  std::vector<std::size_t> unknown;
  for (const fs::path& manifest : driver_manifests(std::getenv)) {
    keys.push_back(driver_key(manifest, loader));
    const auto known = recall(keys.back(), probing.memory, now);
    if (!known) unknown.push_back(probed.drivers.size());
    DriverReport unasked;
    unasked.manifest = manifest;
    probed.drivers.push_back(known ? report_of(manifest, *known) : unasked);
  }
  if (!unknown.empty()) ask(probing, program, unknown, keys, now, probed);
  return probed;
}

}  // namespace flowdlo::vulkan
