#include "vulkan/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "reference/program.hpp"

namespace flowdlo::vulkan::testing {

void expect_near(const std::vector<float>& expected, const std::vector<float>& got,
                 float relative) {
  ASSERT_EQ(expected.size(), got.size());
  float largest = 0;
  for (const float value : expected) largest = std::max(largest, std::abs(value));
  float worst = 0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_TRUE(std::isfinite(got[i])) << "entry " << i;
    if (std::abs(got[i] - expected[i]) <= worst) continue;
    worst = std::abs(got[i] - expected[i]);
    where = i;
  }
  EXPECT_LE(worst, relative * largest)
      << "entry " << where << ": expected " << expected[where] << ", got " << got[where];
}

const std::vector<std::shared_ptr<Device>>& devices() {
  static const std::vector<std::shared_ptr<Device>> opened = [] {
    std::vector<std::shared_ptr<Device>> result;
    for (const DeviceReport& report : survey().devices) {
      if (!report.lacks.empty()) continue;
      auto device = open_device({.wanted = report.uuid});
      if (device) result.push_back(*device);
    }
    return result;
  }();
  return opened;
}

ops::Tensor Trial::input(int rows, int columns, std::vector<float> values) {
  const ops::Tensor tensor = program_->input("in " + std::to_string(inputs_.size()), rows, columns);
  inputs_.emplace_back(tensor, std::move(values));
  return tensor;
}

ops::Tensor Trial::output(int rows, int columns) {
  outputs_.push_back(program_->output("out " + std::to_string(outputs_.size()), rows, columns));
  return outputs_.back();
}

ops::LinearLayer Trial::layer(int out, int in, std::uint64_t seed) {
  const auto weights = static_cast<std::size_t>(out) * static_cast<std::size_t>(in);
  const float scale = 1.0F / std::sqrt(static_cast<float>(in));
  return program_->layer("layer", out, in, noise(weights, seed, scale),
                         noise(static_cast<std::size_t>(out), seed + 1));
}

Outputs Trial::run_once() {
  for (const auto& [tensor, values] : inputs_) program_->write(tensor, values);
  const auto done = program_->run();
  EXPECT_TRUE(done) << done.error().message;
  Outputs results;
  for (const ops::Tensor& tensor : outputs_) {
    std::vector<float> values(static_cast<std::size_t>(tensor.rows) *
                              static_cast<std::size_t>(tensor.columns));
    program_->read(tensor, values);
    results.push_back(std::move(values));
  }
  return results;
}

Outputs Trial::run() {
  const auto built = program_->build();
  EXPECT_TRUE(built) << built.error().message;
  return built ? run_once() : Outputs{};
}

Outputs Trial::run_again(const std::vector<std::vector<float>>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) inputs_[i].second = values[i];
  return run_once();
}

Outputs run_on_cpu(const Record& record) {
  Trial trial(reference::create_program(1));
  record(trial);
  return trial.run();
}

Outputs run_on(const std::shared_ptr<Device>& device, const Record& record) {
  Trial trial(create_program(device, {.timeout_ms = 60000, .pipeline_cache = {}}));
  record(trial);
  return trial.run();
}

void expect_twins(const Record& record, float relative) {
  const Outputs expected = run_on_cpu(record);
  for (const auto& device : devices()) {
    SCOPED_TRACE(report(*device).name);
    const Outputs got = run_on(device, record);
    ASSERT_EQ(expected.size(), got.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      SCOPED_TRACE("output " + std::to_string(i));
      expect_near(expected[i], got[i], relative);
    }
  }
}

void expect_equal_bits(const Record& record) {
  const Outputs expected = run_on_cpu(record);
  for (const auto& device : devices()) {
    SCOPED_TRACE(report(*device).name);
    const Outputs got = run_on(device, record);
    ASSERT_EQ(expected.size(), got.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_EQ(expected[i].size(), got[i].size());
      EXPECT_EQ(0, std::memcmp(expected[i].data(), got[i].data(), 4 * got[i].size()))
          << "output " << i;
    }
  }
}

}  // namespace flowdlo::vulkan::testing
