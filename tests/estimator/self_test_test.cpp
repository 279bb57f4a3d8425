#include "estimator/self_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/program.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;

/// The CPU back end behind a fault: what a bad driver looks like from outside.
class FaultyProgram final : public ops::Program {
 public:
  enum class Fault { kNone, kWrongNumbers, kOtherPoints, kLost };
  explicit FaultyProgram(Fault fault) : fault_(fault), inner_(reference::create_program(1)) {}

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
    if (fault_ == Fault::kLost) return Error{ErrorCode::kDeviceLost, "the device went away"};
    return inner_->run();
  }
  void read(ops::Tensor t, std::span<float> values) const override {
    inner_->read(t, values);
    const bool is_prediction = values.size() == 64 * 4;
    const bool is_visible = values.size() == 256 * 4;
    if (fault_ == Fault::kWrongNumbers && is_prediction) values[40] += 0.001F;
    if (fault_ == Fault::kOtherPoints && is_visible) std::swap(values[0], values[4]);
  }
  std::vector<std::pair<std::string, double>> stage_times_ms() const override {
    return inner_->stage_times_ms();
  }

 private:
  Fault fault_;
  std::unique_ptr<ops::Program> inner_;
};

estimator::Verdict verdict_on(FaultyProgram::Fault fault) {
  return estimator::self_test([fault] { return std::make_unique<FaultyProgram>(fault); });
}

TEST(SelfTest, PassesOnTheCpuBackEnd) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kNone);
  EXPECT_TRUE(verdict.passed) << verdict.text;
}

TEST(SelfTest, FailsWhenOneNodeIsAMillimetreOff) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kWrongNumbers);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.text, HasSubstr("1 mm"));
}

TEST(SelfTest, FailsWhenOtherPointsArePicked) {
  EXPECT_FALSE(verdict_on(FaultyProgram::Fault::kOtherPoints).passed);
}

TEST(SelfTest, FailsWithTheDevicesOwnSentence) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kLost);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.text, HasSubstr("the device went away"));
}

}  // namespace
}  // namespace flowdlo
