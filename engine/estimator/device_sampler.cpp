#include "estimator/device_sampler.hpp"

#include <algorithm>

#include "estimator/opening.hpp"

namespace flowdlo::estimator {
namespace {

constexpr const char* kCpu = "cpu";

/// The model on the device that "auto" takes now; none where that is the CPU, or where it fails.
std::optional<OnDevice> on_device(const Config& config, const flow::WeightsSource& weights) {
  const auto back_end = choose_back_end(config);
  if (!back_end || back_end->name == kCpu) return std::nullopt;
  auto sampler = flow::Sampler::create(weights, back_end->make_program, sampler_config(config));
  if (!sampler) return std::nullopt;
  return OnDevice{back_end->name, *std::move(sampler)};
}

/// Whether the CPU takes the place of a device that failed so. Without memory it would fail too.
bool replaceable(const Config& config, const std::string& device, const Error& error) {
  return config.device == "auto" && device != kCpu && error.code != ErrorCode::kOutOfMemory;
}

}  // namespace

Result<DeviceSampler> DeviceSampler::create(const Config& config, flow::WeightsSource weights,
                                            BackEnd back_end, Pace pace) {
  const bool comes_back = !back_end.fetch;
  auto sampler = flow::Sampler::create(weights, back_end.make_program, sampler_config(config));
  if (sampler) {
    return DeviceSampler(config, std::move(weights), pace, comes_back, std::move(back_end.name),
                         *std::move(sampler));
  }
  if (!replaceable(config, back_end.name, sampler.error())) return sampler.error();
  auto cpu = cpu_back_end(config.threads);
  auto replacement = flow::Sampler::create(weights, cpu.make_program, sampler_config(config));
  if (!replacement) return replacement.error();
  DeviceSampler result(config, std::move(weights), pace, comes_back, std::move(cpu.name),
                       *std::move(replacement));
  result.begin_comeback();
  return result;
}

void DeviceSampler::begin_comeback() {
  if (!comes_back_) return;
  Pace pace = pace_;
  pace.first = next_;
  comeback_ = std::make_unique<Comeback>(
      [config = config_, weights = weights_] { return on_device(config, weights); }, pace);
}

/// To the device that has passed its self-test meanwhile, where there is one.
void DeviceSampler::go_back() {
  if (!comeback_) return;
  auto found = comeback_->take();
  if (!found) return;
  device_ = std::move(found->device);
  sampler_ = std::move(found->sampler);
  comeback_.reset();
  back_since_ = Clock::now();
}

Result<flow::Prediction> DeviceSampler::sample(const flow::SampleInput& input) {
  go_back();
  auto prediction = sampler_.sample(input);
  if (prediction || !replaceable(config_, device_, prediction.error())) return prediction;
  const auto cpu = cpu_back_end(config_.threads);
  auto replacement = flow::Sampler::create(weights_, cpu.make_program, sampler_config(config_));
  if (!replacement) return prediction;
  sampler_ = *std::move(replacement);
  device_ = cpu.name;
  const bool again = back_since_ && Clock::now() - *back_since_ < pace_.longest;
  next_ = again ? std::min(2 * next_, pace_.longest) : pace_.first;
  begin_comeback();
  return sampler_.sample(input);
}

}  // namespace flowdlo::estimator
