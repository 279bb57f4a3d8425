#include "vulkan/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>

#include "vulkan/device.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/gemm_candidates.hpp"
#include "vulkan/gemm_trial.hpp"

namespace flowdlo::vulkan {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kKind = "gemm";
constexpr double kBudget_ms = 100;
// Most of a CPU driver's trial is its compiler, 0.3 to 1 s a candidate: what is begun after this
// much time beyond the first candidate, which is compiled in any case, is not worth a start's
// while.
constexpr double kCpuBudget_ms = 2000;
// A later candidate must be clearly faster: noise must not change a device's bits from run to run.
constexpr double kClearly = 0.9;

/// What `content` says, where it is still one of the candidates.
std::optional<GemmChoice> choice_of(const std::vector<char>& content,
                                    const std::vector<GemmChoice>& candidates) {
  GemmChoice choice;
  if (content.size() != sizeof(choice)) return std::nullopt;
  std::memcpy(&choice, content.data(), sizeof(choice));
  const bool known = std::find(candidates.begin(), candidates.end(), choice) != candidates.end();
  return known ? std::optional(choice) : std::nullopt;
}

std::vector<char> content_of(const GemmChoice& choice) {
  static_assert(std::has_unique_object_representations_v<GemmChoice>);
  std::vector<char> content(sizeof(choice));
  std::memcpy(content.data(), &choice, sizeof(choice));
  return content;
}

bool is_cpu_driver(const Device& device) { return device.facts().report.kind == DeviceKind::kCpu; }

Result<GemmChoice> best_of(const std::shared_ptr<Device>& device,
                           const std::vector<GemmChoice>& candidates,
                           const ProgramOptions& options) {
  const bool is_cpu = is_cpu_driver(*device);
  const bool keeps = !options.pipeline_cache.empty();
  auto start = Clock::now();
  std::optional<GemmChoice> best;
  double best_ms = 0;
  std::string faults;
  for (const GemmChoice& candidate : candidates) {
    // A CPU driver's tiles are tried against each other where the best is remembered; another
    // kernel is what there is where all of them are wrong.
    if (is_cpu && best && (!keeps || candidate.family != best->family)) break;
    const auto time_ms = try_gemm(device, candidate, options);
    if (!time_ms) {
      faults += fmt::format("{}{}", faults.empty() ? "" : "; ", time_ms.error().message);
      const ErrorCode code = time_ms.error().code;
      // Neither says anything of the candidate.
      if (code == ErrorCode::kDeviceLost || code == ErrorCode::kOutOfMemory) return time_ms.error();
      continue;
    }
    if (is_cpu && !best) start = Clock::now();
    if (!best || *time_ms < kClearly * best_ms) {
      best = candidate;
      best_ms = *time_ms;
    }
    const std::chrono::duration<double, std::milli> elapsed = Clock::now() - start;
    if (elapsed.count() > (is_cpu ? kCpuBudget_ms : kBudget_ms)) break;
  }
  if (best) return *best;
  return Error{ErrorCode::kNoDevice,
               fmt::format("\"{}\": expected a kernel for dense layers that returns right numbers, "
                           "got none ({}); update its driver or choose another device",
                           device->facts().report.name, faults)};
}

}  // namespace

Result<GemmChoice> choose_gemm(const std::shared_ptr<Device>& device,
                               const ProgramOptions& options) {
  if (options.gemm) return *options.gemm;
  const std::lock_guard lock(device->tuning_mutex());
  if (device->gemm()) return *device->gemm();
  const std::vector<GemmChoice> candidates = gemm_candidates(device->facts());
  const std::filesystem::path& folder = options.pipeline_cache;
  // A CPU driver that has no folder gets its first candidate, always.
  const bool is_kept = !folder.empty() || !is_cpu_driver(*device);
  auto choice = is_kept ? choice_of(known(*device, folder, kKind), candidates) : std::nullopt;
  if (!choice) {
    const auto best = best_of(device, candidates, options);
    if (!best) return best.error();
    // Under validation layers there are fewer candidates: what is kept may be none of them.
    if (is_kept) choice = choice_of(settle(*device, folder, kKind, content_of(*best)), candidates);
    if (!choice) choice = *best;
  }
  device->remember(*choice);
  return *choice;
}

}  // namespace flowdlo::vulkan
