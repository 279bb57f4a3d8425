// DeviceSampler: the model's predictions on the device that was asked for, or on what takes its
// place.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/comeback.hpp"
#include "estimator/device_choice.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

/// Where the device was left to us ("auto"), one that fails is replaced by the CPU: for good where
/// it is the host's, which nobody here can make anew; any other is tried again beside the frames
/// (Comeback) until it is there again. One that is lost once more within Pace::longest is tried
/// after twice the time that it was left alone before.
class DeviceSampler {
 public:
  /// `config`: as it is resolved. Fails as flow::Sampler::create does; with "auto" only for want of
  /// memory.
  [[nodiscard]] static Result<DeviceSampler> create(const Config& config,
                                                    flow::WeightsSource weights, BackEnd back_end,
                                                    Pace pace = Pace());

  [[nodiscard]] Result<flow::Prediction> sample(const flow::SampleInput& input);

  /// "cpu", or the name of the Vulkan device in use.
  [[nodiscard]] const std::string& device() const { return device_; }
  [[nodiscard]] const std::vector<float>& source() const { return sampler_.source(); }
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const {
    return sampler_.stage_times_ms();
  }

 private:
  using Clock = std::chrono::steady_clock;

  DeviceSampler(const Config& config, flow::WeightsSource weights, Pace pace, bool comes_back,
                std::string device, flow::Sampler sampler)
      : config_(config),
        weights_(std::move(weights)),
        pace_(pace),
        next_(pace.first),
        comes_back_(comes_back),
        device_(std::move(device)),
        sampler_(std::move(sampler)) {}

  void go_back();
  void begin_comeback();

  Config config_;
  flow::WeightsSource weights_;
  Pace pace_;
  std::chrono::milliseconds next_;  // how long a device that is lost now is left alone at first
  bool comes_back_;                 // it is a device of our own
  std::string device_;
  flow::Sampler sampler_;
  std::optional<Clock::time_point> back_since_;
  std::unique_ptr<Comeback> comeback_;
};

}  // namespace flowdlo::estimator
