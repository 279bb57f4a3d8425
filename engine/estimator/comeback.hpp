// Comeback: after a device was lost, another try at one, again and again, beside the frames.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "field/network.hpp"
#include "flow/sampler.hpp"

namespace flowdlo::estimator {

/// What is made on a device.
struct OnDevice {
  std::string device;  ///< its name
  flow::Sampler sampler;
  std::optional<field::Network> field{};
  std::string field_device{};  ///< where the field's network runs; empty without one
};

/// How long is waited before the first try; each later wait is twice as long, up to `longest`.
struct Pace {
  std::chrono::milliseconds first{1000};
  std::chrono::milliseconds longest{300000};
};

/// Not to be destroyed in a process that was forked from its own, where the thread is missing.
class Comeback {
 public:
  /// One try. None: not yet.
  using Try = std::function<std::optional<OnDevice>()>;

  /// Begins on a thread of its own; where none can be started there is no coming back.
  explicit Comeback(Try once, Pace pace = Pace());
  /// Waits for a try that is under way.
  ~Comeback();
  Comeback(const Comeback&) = delete;
  Comeback& operator=(const Comeback&) = delete;

  /// What a try gave, once; never waits for one.
  [[nodiscard]] std::optional<OnDevice> take();

 private:
  void go_on();

  const Try once_;
  const Pace pace_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  std::optional<OnDevice> found_;
  std::thread thread_;
};

}  // namespace flowdlo::estimator
