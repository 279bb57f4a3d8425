#include "wide_lavapipe.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "exit_code.hpp"

namespace flowdlo::support {
namespace {

constexpr const char* kWidth = "LP_NATIVE_VECTOR_WIDTH";

bool has_wide_vectors() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

/// "auto" takes no CPU driver.
bool may_mean_lavapipe(const std::string& wanted_device) {
  return wanted_device != "auto" && wanted_device != "cpu";
}

/// Does not return: this process must not go on with a driver that miscalculates.
[[noreturn]] void run_anew() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < words.size(); at = words.find('\0', at) + 1) {
    arguments.push_back(words.data() + at);
  }
  arguments.push_back(nullptr);
  ::setenv(kWidth, "256", 1);
  ::execv("/proc/self/exe", arguments.data());
  fmt::print(stderr, "flowdlo: expected to run anew with {0}=256, could not; set it yourself\n",
             kWidth);
  std::_Exit(static_cast<int>(ExitCode::kFailed));
}

}  // namespace

bool bears_sixteen_lanes(const DeviceReport& device) {
  const bool is_lavapipe = device.name.find("llvmpipe") != std::string::npos;
  return !is_lavapipe || device.driver.find("Mesa 22.3.") != std::string::npos;
}

void widen_lavapipe(const std::string& wanted_device) {
  if (!may_mean_lavapipe(wanted_device) || !has_wide_vectors()) return;
  if (std::getenv(kWidth) != nullptr) return;
  ::setenv(kWidth, "512", 1);
  const DeviceSurvey survey = survey_devices(/*self_test=*/false);
  if (!std::all_of(survey.vulkan.begin(), survey.vulkan.end(), bears_sixteen_lanes)) run_anew();
}

}  // namespace flowdlo::support
