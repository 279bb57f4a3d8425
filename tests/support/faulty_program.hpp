// FaultyProgram: a back end with one fault, for what has to notice it.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "ops/program.hpp"
#include "reference/program.hpp"

namespace flowdlo::testing {

/// The CPU back end behind a fault: what a bad driver looks like from outside.
class FaultyProgram final : public ops::Program {
 public:
  enum class Fault { kNone, kWrongNumbers, kOtherPoints, kWrongField, kLost };
  /// `good_runs`: those before a device is lost.
  explicit FaultyProgram(Fault fault, int good_runs = 0)
      : fault_(fault), good_runs_(good_runs), inner_(reference::create_program(1)) {}

  ops::Tensor input(std::string_view n, int r, int c) override { return inner_->input(n, r, c); }
  ops::Tensor output(std::string_view n, int r, int c) override { return inner_->output(n, r, c); }
  ops::Tensor scratch(std::string_view n, int r, int c) override {
    return inner_->scratch(n, r, c);
  }
  ops::Tensor constant(std::string_view n, int r, int c, std::span<const float> v) override {
    return inner_->constant(n, r, c, v);
  }
  ops::LinearLayer layer(std::string_view n, int out, int in, std::span<const float> w,
                         std::span<const float> b) override {
    return inner_->layer(n, out, in, w, b);
  }
  ops::ConvolutionLayer convolution(std::string_view n, int out, int taps, int in,
                                    std::span<const float> w, std::span<const float> b) override {
    return inner_->convolution(n, out, taps, in, w, b);
  }
  void record(const ops::Linear& op) override { inner_->record(op); }
  void record(const ops::Narrow& op) override { inner_->record(op); }
  void record(const ops::LayerNorm& op) override { inner_->record(op); }
  void record(const ops::Attention& op) override { inner_->record(op); }
  void record(const ops::FarthestPoints& op) override { inner_->record(op); }
  void record(const ops::FrameNormalization& op) override { inner_->record(op); }
  void record(const ops::Normalize& op) override { inner_->record(op); }
  void record(const ops::Denormalize& op) override { inner_->record(op); }
  void record(const ops::MaskFeatures& op) override { inner_->record(op); }
  void record(const ops::FlowStep& op) override { inner_->record(op); }
  void record(const ops::Convolution& op) override { inner_->record(op); }
  void record(const ops::MaxPool& op) override { inner_->record(op); }
  void record(const ops::AddUpsampled& op) override { inner_->record(op); }
  void record(const ops::Copy& op) override { inner_->record(op); }
  void stage(std::string_view name) override { inner_->stage(name); }
  Result<void> build() override { return inner_->build(); }
  void write(ops::Tensor t, std::span<const float> v) override { inner_->write(t, v); }
  Result<void> run() override {
    if (fault_ == Fault::kLost && good_runs_-- <= 0) {
      return Error{ErrorCode::kDeviceLost, "the device went away"};
    }
    return inner_->run();
  }
  void read(ops::Tensor t, std::span<float> values) const override {
    inner_->read(t, values);
    const bool is_prediction = values.size() == 64 * 4;
    const bool is_visible = values.size() == 256 * 4;
    const bool is_field = values.size() > 256 * 4;
    if (fault_ == Fault::kWrongNumbers && is_prediction) values[40] += 0.001F;
    if (fault_ == Fault::kOtherPoints && is_visible) std::swap(values[0], values[4]);
    if (fault_ == Fault::kWrongField && is_field) values[values.size() / 2] += 1;
  }
  std::vector<std::pair<std::string, double>> stage_times_ms() const override {
    return inner_->stage_times_ms();
  }

 private:
  Fault fault_;
  int good_runs_;
  std::unique_ptr<ops::Program> inner_;
};

}  // namespace flowdlo::testing
