// Trial: one recording on one program; Twins: the same recording on the CPU and on every device.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ops/program.hpp"
#include "support/program_cases.hpp"
#include "vulkan/backend.hpp"

namespace flowdlo::vulkan::testing {

using flowdlo::testing::noise;
using Outputs = std::vector<std::vector<float>>;

/// Every usable device of this machine, opened once a process.
const std::vector<std::shared_ptr<Device>>& devices();

/// Gathers inputs and outputs while a test records.
class Trial {
 public:
  explicit Trial(std::unique_ptr<ops::Program> program) : program_(std::move(program)) {}

  ops::Tensor input(int rows, int columns, std::vector<float> values);
  ops::Tensor output(int rows, int columns);
  ops::LinearLayer layer(int out, int in, std::uint64_t seed);
  ops::Program* operator->() { return program_.get(); }

  /// Builds, writes the inputs, runs; every output in order of declaration.
  Outputs run();
  /// Once more, with other values of the inputs.
  Outputs run_again(const std::vector<std::vector<float>>& values);

 private:
  Outputs run_once();

  std::unique_ptr<ops::Program> program_;
  std::vector<std::pair<ops::Tensor, std::vector<float>>> inputs_;
  std::vector<ops::Tensor> outputs_;
};

using Record = std::function<void(Trial&)>;

Outputs run_on_cpu(const Record& record);
Outputs run_on(const std::shared_ptr<Device>& device, const Record& record);

/// Fails where an entry differs by more than relative * (largest magnitude expected).
void expect_near(const std::vector<float>& expected, const std::vector<float>& got, float relative);

/// Fails where any output of any device differs from the CPU's by more than
/// relative * (largest magnitude of that output).
void expect_twins(const Record& record, float relative);

/// As above; not a bit may differ.
void expect_equal_bits(const Record& record);

#define FLOWDLO_NEEDS_DEVICE() \
  if (::flowdlo::vulkan::testing::devices().empty()) GTEST_SKIP() << "no usable Vulkan device"

}  // namespace flowdlo::vulkan::testing
