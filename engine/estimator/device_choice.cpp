#include "estimator/device_choice.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <utility>

#include "estimator/cache_folder.hpp"
#include "estimator/self_test.hpp"
#include "flowdlo/devices.hpp"
#include "guard/caught.hpp"
#include "reference/program.hpp"

#ifdef FLOWDLO_WITH_VULKAN
#include "vulkan/backend.hpp"
#include "vulkan/readback.hpp"
#endif

namespace flowdlo::estimator {
namespace {

#ifdef FLOWDLO_WITH_VULKAN

bool is_real_gpu(const DeviceReport& report) {
  return vulkan::preference(report.kind) <= vulkan::preference(DeviceKind::kVirtualGpu);
}

/// Config::device_timeout_ms, where it is left to us: a hung device must not hold a robot for long,
/// and a slow one must not be called lost.
int timeout_ms(const Config& config, DeviceKind kind) {
  if (config.device_timeout_ms > 0) return config.device_timeout_ms;
  constexpr int kUsualWork = 40;  // four draws of ten steps
  constexpr int kUsual_ms = 10000;
  constexpr int kCpuDriverFactor = 6;
  const int work = std::max(config.draws * config.euler_steps, kUsualWork);
  return kUsual_ms / kUsualWork * work * (kind == DeviceKind::kCpu ? kCpuDriverFactor : 1);
}

/// How drivers are asked before they are loaded. FLOWDLO_PROBE_MS: what one may take.
vulkan::Probing probing_of(const Config& config) {
  vulkan::Probing probing{.on = config.probe, .memory = cache_folder(std::getenv)};
  constexpr long kLongest_ms = 3600000;
  const char* const limit = std::getenv("FLOWDLO_PROBE_MS");
  const long wanted_ms = limit != nullptr ? std::strtol(limit, nullptr, 10) : 0;
  if (wanted_ms > 0) probing.limit_ms = static_cast<int>(std::min(wanted_ms, kLongest_ms));
  return probing;
}

BackEnd on_device(const Config& config, const std::shared_ptr<vulkan::Device>& device) {
  const DeviceReport& report = vulkan::report(*device);
  const vulkan::ProgramOptions options{.timeout_ms = timeout_ms(config, report.kind),
                                       .pipeline_cache = cache_folder(std::getenv)};
  return {.name = report.name,
          .make_program = [device, options] { return vulkan::create_program(device, options); },
          .gpu = is_real_gpu(report),
          .settled =
              [device, folder = options.pipeline_cache](auto kind, const auto& find_out) {
                return vulkan::settled(*device, folder, kind, find_out);
              }};
}

Result<BackEnd> open_vulkan(const Config& config, const std::string& wanted) {
  auto opened = vulkan::open_device({.wanted = wanted,
                                     .allow_cpu_driver = true,
                                     .validation = config.validation,
                                     .probing = probing_of(config)});
  if (!opened) return opened.error();
  return on_device(config, *opened);
}

Result<BackEnd> open_handed_over(const Config& config, const VulkanHost& host) {
  if (config.device != kAuto && config.device != "vulkan") {
    return Error{ErrorCode::kBadInput,
                 "Config.device: expected \"auto\" or \"vulkan\" beside a VulkanHost, got \"" +
                     config.device + "\"; leave out the VulkanHost for a device of FlowDLO's own"};
  }
  const auto adopted = vulkan::adopt_device(host);
  if (!adopted) return adopted.error();
  BackEnd back_end = on_device(config, *adopted);
  if (config.device == kAuto) {
    const Verdict verdict = self_test(back_end.make_program);
    if (!verdict.passed) {
      return Error{ErrorCode::kNoDevice,
                   "VulkanHost.device: expected one whose self-test passes, got \"" +
                       back_end.name + "\": " + verdict.text +
                       "; update its driver, or take the device \"cpu\""};
    }
  }
  const auto readback = std::make_shared<vulkan::Readback>(
      *adopted, timeout_ms(config, vulkan::report(**adopted).kind));
  back_end.fetch = [readback](const VulkanFrame& frame) { return readback->read(frame); };
  return back_end;
}

/// Usable devices in the order in which "auto" tries them.
std::vector<DeviceReport> real_gpus(std::vector<DeviceReport> reports) {
  std::erase_if(reports, [](const DeviceReport& report) {
    return !is_real_gpu(report) || !report.lacks.empty();
  });
  std::stable_sort(reports.begin(), reports.end(),
                   [](const DeviceReport& a, const DeviceReport& b) {
                     return vulkan::preference(a.kind) < vulkan::preference(b.kind);
                   });
  return reports;
}

BackEnd choose_automatically(const Config& config) {
  for (const DeviceReport& report : real_gpus(vulkan::survey(probing_of(config)).devices)) {
    auto back_end = open_vulkan(config, report.uuid);
    if (back_end && self_test(back_end->make_program).passed) return *back_end;
  }
  return cpu_back_end(config.threads);
}

#else

Result<BackEnd> open_vulkan(const Config& config, const std::string&) {
  return Error{ErrorCode::kNoDevice, "Config.device: expected \"auto\" or \"cpu\", got \"" +
                                         config.device +
                                         "\"; this library was built without Vulkan"};
}

Result<BackEnd> open_handed_over(const Config&, const VulkanHost&) {
  return Error{
      ErrorCode::kNoDevice,
      "VulkanHost: expected a library with Vulkan, got one that was built without; build it "
      "with FLOWDLO_WITH_VULKAN=ON"};
}

BackEnd choose_automatically(const Config& config) { return cpu_back_end(config.threads); }

#endif

}  // namespace

BackEnd cpu_back_end(int threads) {
  return {.name = kCpu, .make_program = [threads] { return reference::create_program(threads); }};
}

Result<BackEnd> choose_back_end(const Config& config) {
  if (config.device == kCpu) return cpu_back_end(config.threads);
  if (config.device == kAuto) return choose_automatically(config);
  return open_vulkan(config, config.device);
}

Result<BackEnd> host_back_end(const Config& config, const VulkanHost& host) {
  return open_handed_over(config, host);
}

}  // namespace flowdlo::estimator

namespace flowdlo {
namespace {

DeviceSurvey surveyed(bool self_test, bool probe) {
  DeviceSurvey survey;
#ifdef FLOWDLO_WITH_VULKAN
  Config config;
  config.probe = probe;
  vulkan::Survey found = vulkan::survey(estimator::probing_of(config));
  survey.drivers = std::move(found.probed.drivers);
  survey.unseen = std::move(found.probed.unseen);
  survey.vulkan = std::move(found.devices);
  survey.loader = std::move(found.loader);
  survey.advice = std::move(found.advice);
  for (DeviceReport& report : survey.vulkan) {
    if (!self_test || !report.lacks.empty()) continue;
    report.self_test_run = true;
    const auto back_end = estimator::open_vulkan(config, report.uuid);
    const estimator::Verdict verdict = back_end
                                           ? estimator::self_test(back_end->make_program)
                                           : estimator::Verdict{false, back_end.error().message};
    report.self_test_passed = verdict.passed;
    report.self_test = verdict.text;
  }
  survey.auto_choice = estimator::kCpu;
  for (const DeviceReport& report : estimator::real_gpus(survey.vulkan)) {
    if (report.self_test_run && !report.self_test_passed) continue;
    survey.auto_choice = report.name;
    break;
  }
#else
  (void)self_test;
  (void)probe;
  survey.loader = "none";
  survey.advice = "this library was built without Vulkan; build it with FLOWDLO_WITH_VULKAN=ON";
  survey.auto_choice = estimator::kCpu;
#endif
  return survey;
}

}  // namespace

DeviceSurvey survey_devices(bool self_test, bool probe) {
  try {
    return surveyed(self_test, probe);
  } catch (const std::exception&) {
    return {.drivers = {},
            .unseen = {},
            .vulkan = {},
            .loader = guard::caught("survey_devices").message,
            .advice = {},
            .auto_choice = estimator::kCpu};  // needs no Vulkan, and no memory to be said
  }
}

}  // namespace flowdlo
