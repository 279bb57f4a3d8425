// DeviceNetworks: the velocity model and the strand field on the device that was asked for, or on
// what takes its place.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/comeback.hpp"
#include "estimator/device_choice.hpp"
#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::estimator {

/// What is made on a device, and made anew where it comes back.
struct Wanted {
  Config config;  ///< as it is resolved
  flow::WeightsSource model;
  bool model_idle = false;  ///< few frames ask for it: it is built by the first that does
  std::shared_ptr<const weights::FieldWeights> field{};  ///< null: none
};

/// Where the device was left to us ("auto"), one that fails is replaced by the CPU: for good where
/// it is the host's, which nobody here can make anew; any other is tried again beside the frames
/// (Comeback) until it is there again. One that is lost once more within Pace::longest is tried
/// after twice the time that it was left alone before.
class DeviceNetworks {
 public:
  /// Fails as flow::Sampler::create and field::Network::create do; with "auto" only for want of
  /// memory.
  [[nodiscard]] static Result<DeviceNetworks> create(Wanted wanted, BackEnd back_end,
                                                     Pace pace = Pace());

  /// Before each frame: takes a device that is back, and lets go of one that the field has lost.
  void begin_frame();

  /// May be called beside what is done with the field.
  [[nodiscard]] Result<flow::Prediction> sample(const flow::SampleInput& input);

  /// Null where there is none; good until the next begin_frame.
  [[nodiscard]] field::Network* field() { return now_.field ? &*now_.field : nullptr; }

  /// "cpu", or the name of the Vulkan device in use.
  [[nodiscard]] const std::string& device() const { return now_.device; }
  /// The same of the field's network; empty without one.
  [[nodiscard]] const std::string& field_device() const;
  [[nodiscard]] const std::vector<float>& source() const { return now_.sampler.source(); }
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const {
    return now_.sampler.stage_times_ms();
  }

 private:
  using Clock = std::chrono::steady_clock;

  DeviceNetworks(Wanted wanted, Pace pace, bool comes_back, OnDevice now)
      : wanted_(std::move(wanted)),
        pace_(pace),
        next_(pace.first),
        comes_back_(comes_back),
        now_(std::move(now)) {}

  void lost();
  void begin_comeback();

  Wanted wanted_;
  Pace pace_;
  std::chrono::milliseconds next_;  // how long a device that is lost now is left alone at first
  bool comes_back_;                 // it is a device of our own
  OnDevice now_;
  std::optional<Clock::time_point> back_since_;
  std::unique_ptr<Comeback> comeback_;
};

}  // namespace flowdlo::estimator
