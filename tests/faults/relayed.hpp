// Relayed: a machine whose only Vulkan driver is the relay, over lavapipe.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "frame/temporary_folder.hpp"
#include "support/relay.hpp"
#include "support/variable.hpp"

namespace flowdlo::testing {

/// The relay's table; null where this machine has no lavapipe. The driver stays loaded.
[[nodiscard]] const RelayTable* relay();

class Relayed : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  test::TemporaryFolder scratch_;

 private:
  std::optional<test::Drivers> drivers_;
  test::Variable cache_{"FLOWDLO_CACHE", (scratch_.path() / "cache").string()};
};

}  // namespace flowdlo::testing
