// Program: ops::Program on a Vulkan device. Recorded once, replayed: one submission a run.
#pragma once

#include <memory>
#include <optional>

#include "ops/program.hpp"
#include "vulkan/backend.hpp"
#include "vulkan/dense_layer.hpp"
#include "vulkan/device.hpp"
#include "vulkan/plan.hpp"
#include "vulkan/recorders.hpp"
#include "vulkan/recording.hpp"
#include "vulkan/submission.hpp"
#include "vulkan/timestamps.hpp"

namespace flowdlo::vulkan {

class Program final : public ops::Program {
 public:
  Program(std::shared_ptr<Device> device, ProgramOptions options);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  /// Waits a bounded time for a run that timed out. What a hung device still holds is given up,
  /// not freed: freeing it would be undefined.
  ~Program() override;

  ops::Tensor input(std::string_view name, int rows, int columns) override {
    return work_->plan.tensor(Home::kInput, name, rows, columns);
  }
  ops::Tensor output(std::string_view name, int rows, int columns) override {
    return work_->plan.tensor(Home::kOutput, name, rows, columns);
  }
  ops::Tensor scratch(std::string_view name, int rows, int columns) override {
    return work_->plan.scratch(name, rows, columns);
  }
  ops::Tensor constant(std::string_view name, int rows, int columns,
                       std::span<const float> values) override {
    return work_->plan.tensor(Home::kDevice, name, rows, columns, {values.begin(), values.end()});
  }
  ops::LinearLayer layer(std::string_view name, int out, int in, std::span<const float> weight,
                         std::span<const float> bias) override;
  ops::ConvolutionLayer convolution(std::string_view name, int out, int taps, int in,
                                    std::span<const float> weight,
                                    std::span<const float> bias) override;

  /// On CPU drivers: 257 dispatches there take longer than the sampling itself on the host.
  [[nodiscard]] bool host_samples_points() const override {
    return work_->device->facts().report.kind == DeviceKind::kCpu;
  }

  void record(const ops::Linear& op) override;
  void record(const ops::Narrow& op) override;
  void record(const ops::LayerNorm& op) override;
  void record(const ops::Attention& op) override;
  void record(const ops::FarthestPoints& op) override;
  void record(const ops::FrameNormalization& op) override;
  void record(const ops::Normalize& op) override;
  void record(const ops::Denormalize& op) override;
  void record(const ops::MaskFeatures& op) override;
  void record(const ops::FlowStep& op) override;
  void record(const ops::Convolution& op) override;
  void record(const ops::MaxPool& op) override;
  void record(const ops::AddUpsampled& op) override;
  void record(const ops::Copy& op) override;
  void stage(std::string_view name) override { work_->plan.stage(name); }

  [[nodiscard]] Result<void> build() override;
  void write(ops::Tensor input, std::span<const float> values) override;
  [[nodiscard]] Result<void> run() override;
  void read(ops::Tensor output, std::span<float> values) const override;
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const override;

 private:
  /// Everything that a running command buffer may touch.
  struct Work {
    explicit Work(std::shared_ptr<Device> shared) : device(std::move(shared)), plan(*device) {}

    std::shared_ptr<Device> device;  // outlives all below
    Plan plan;
    Compiled compiled;
    Timestamps timestamps;
    Buffer staging;
    Submission submission;
    VkCommandBuffer commands = VK_NULL_HANDLE;
  };

  /// How dense layers and convolutions run, before the first is declared.
  void choose_gemm_once();
  [[nodiscard]] Result<void> compile();
  [[nodiscard]] Result<void> record_commands();
  [[nodiscard]] Result<void> warm_up();
  /// Frame parameters with which every kernel has something to do, or zeros again.
  void fill_params(bool plausible);

  std::unique_ptr<Work> work_;
  ProgramOptions options_;
  std::vector<DenseLayer> layers_;
  std::vector<ConvolutionWeights> convolutions_;
  std::vector<ops::Tensor> params_;
  std::vector<std::pair<ops::Tensor, std::vector<float>>> early_writes_;  // before build()
  bool chosen_ = false;
  bool built_ = false;
  std::optional<Error> lost_;  // what failed; build() or every later run fails the same way
  double host_ms_ = 0;
};

}  // namespace flowdlo::vulkan
