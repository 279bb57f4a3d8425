#include "estimator/config_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace flowdlo::estimator {

Result<void> check(const Config& config) {
  std::string faults;
  const auto fault = [&](const std::string& line) {
    if (!faults.empty()) faults += '\n';
    faults += line;
  };
  const auto expect = [&](bool fine, const char* field, const char* expected, int got) {
    if (!fine) fault(fmt::format("Config.{}: expected {}, got {}", field, expected, got));
  };
  const auto expect_known = [&](auto choice, auto last, const char* field) {
    const int got = static_cast<int>(choice);
    expect(got >= 0 && got <= static_cast<int>(last), field, "one of its names", got);
  };
  expect(config.euler_steps >= 1 && config.euler_steps <= 64, "euler_steps", "1 to 64",
         config.euler_steps);
  expect(config.draws >= 1 && config.draws <= 64, "draws", "1 to 64", config.draws);
  expect(config.ropes >= 0 && config.ropes <= kMostRopes, "ropes",
         fmt::format("0 (as many as there are) to {}", kMostRopes).c_str(), config.ropes);
  expect(config.threads >= 0 && config.threads <= 1024, "threads", "0 to 1024", config.threads);
  expect(config.max_width >= 1 && config.max_width <= 4096, "max_width", "1 to 4096",
         config.max_width);
  expect(config.max_height >= 1 && config.max_height <= 4096, "max_height", "1 to 4096",
         config.max_height);
  expect_known(config.quality, Quality::kAuto, "quality");
  expect_known(config.prior, PriorChoice::kRefined, "prior");
  expect_known(config.gate, GateChoice::kCalibrated, "gate");
  expect_known(config.field, FieldChoice::kStrands, "field");
  expect_known(config.field_device, FieldDevice::kSame, "field_device");
  if (config.device.empty()) {
    fault(
        "Config.device: expected \"auto\", \"cpu\", \"vulkan\", part of a name or a UUID, got "
        "nothing; \"auto\" always finds one");
  }
  expect(config.device_timeout_ms >= 0, "device_timeout_ms", "at least 0",
         config.device_timeout_ms);
  if (!std::isfinite(config.rope_length_m) || config.rope_length_m < 0) {
    fault(fmt::format("Config.rope_length_m: expected metres, or 0 for unknown, got {}",
                      config.rope_length_m));
  }
  if (!std::isfinite(config.budget_ms) || config.budget_ms < 0) {
    fault(fmt::format("Config.budget_ms: expected milliseconds, or 0 for no limit, got {}",
                      config.budget_ms));
  }
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

}  // namespace flowdlo::estimator
