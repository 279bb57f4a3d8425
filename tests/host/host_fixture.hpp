// HostTest: a host's device and an estimator's bits to compare with. Where the validation layers
// are installed they watch, and have nothing to say until the host is gone.
#pragma once

#include <gmock/gmock.h>

#include <iostream>
#include <memory>
#include <string>

#include "flowdlo/estimator.hpp"
#include "frame/temporary_folder.hpp"
#include "host/host.hpp"
#include "support/estimate_bits.hpp"
#include "support/variable.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {

inline Config host_config() {
  return {.weights = FLOWDLO_WEIGHTS,
          .device = "vulkan",
          .euler_steps = 2,
          .draws = 2,
          .threads = 1,
          .device_timeout_ms = 120000,  // a starved CPU driver is slow, not lost
          .probe = false};
}

class HostTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (Host::make({.layers = false}) == nullptr) GTEST_SKIP() << "no usable Vulkan device";
  }

  /// Makes the host; the test fails where it cannot.
  [[nodiscard]] Host& host(const Wishes& wishes = Wishes()) {
    host_ = Host::make(wishes);
    EXPECT_NE(host_, nullptr);
    heard_ = host_->heard();
    if (!host_->is_watched()) std::cout << "[ host     ] no validation layers" << std::endl;
    return *host_;
  }

  /// The host ends; all that stood on its device must have ended before.
  void end_host() {
    host_.reset();
    if (!heard_) return;
    EXPECT_THAT(heard_->messages, ::testing::IsEmpty());
  }

  void TearDown() override { end_host(); }

  WaveFrame wave_{160, 120, 7.0F};
  test::TemporaryFolder scratch_;

 private:
  test::Variable cache_{"FLOWDLO_CACHE", (scratch_.path() / "cache").string()};
  std::unique_ptr<Host> host_;
  std::shared_ptr<Heard> heard_;
};

}  // namespace flowdlo::testing
