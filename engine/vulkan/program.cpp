#include "vulkan/program.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstring>
#include <utility>

#include "vulkan/pipeline_cache.hpp"
#include "vulkan/tuning.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kShortestBuildTimeout_ms = 60000;  // the first dispatch of a kernel may compile it
constexpr int kFarewell_ms = 5000;               // a destructor's patience with a hung device
constexpr float kWarmUpPoints = 2 * ops::kVisibleRows;
/// Where no kernel for dense layers is right, what is recorded is never built; its weights are laid
/// out all the same, in a way that fits every device.
constexpr GemmChoice kNeverBuilt{GemmFamily::kTile, 32, 32, 16};

}  // namespace

Program::Program(std::shared_ptr<Device> device, ProgramOptions options)
    : work_(std::make_unique<Work>(std::move(device))), options_(std::move(options)) {}

Program::~Program() {
  if (!work_->submission.idle(*work_->device, kFarewell_ms)) {
    (void)work_.release();  // NOLINT: given up on purpose, see the declaration
  }
}

void Program::choose_gemm_once() {
  if (std::exchange(chosen_, true)) return;
  const auto choice = choose_gemm(work_->device, options_);
  if (!choice) lost_ = choice.error();
  work_->plan.choose(choice ? *choice : kNeverBuilt);
}

ops::LinearLayer Program::layer(std::string_view name, int out, int in,
                                std::span<const float> weight, std::span<const float> bias) {
  choose_gemm_once();
  layers_.push_back(keep_layer(work_->plan, name, out, in, weight, bias));
  return {static_cast<std::uint32_t>(layers_.size() - 1), in, out};
}

ops::ConvolutionLayer Program::convolution(std::string_view name, int out, int taps, int in,
                                           std::span<const float> weight,
                                           std::span<const float> bias) {
  choose_gemm_once();
  convolutions_.push_back(keep_convolution(work_->plan, name, out, taps, in, weight, bias));
  return {static_cast<std::uint32_t>(convolutions_.size() - 1), in, out, taps};
}

void Program::record(const ops::Linear& op) {
  record_linear(work_->plan, op, layers_[op.layer.id]);
}

void Program::record(const ops::Narrow& op) {
  record_narrow(work_->plan, op, layers_[op.layer.id]);
}

void Program::record(const ops::LayerNorm& op) { record_layer_norm(work_->plan, op); }

void Program::record(const ops::Attention& op) { record_attention(work_->plan, op); }

void Program::record(const ops::FarthestPoints& op) {
  params_.push_back(op.params);
  record_farthest_points(work_->plan, op);
}

void Program::record(const ops::FrameNormalization& op) {
  record_frame_normalization(work_->plan, op);
}

void Program::record(const ops::Normalize& op) { record_normalize(work_->plan, op); }

void Program::record(const ops::Denormalize& op) { record_denormalize(work_->plan, op); }

void Program::record(const ops::MaskFeatures& op) {
  params_.push_back(op.params);
  record_mask_features(work_->plan, op);
}

void Program::record(const ops::FlowStep& op) {
  record_flow_step(work_->plan, op, layers_[op.head.id]);
}

void Program::record(const ops::Convolution& op) {
  record_convolution(work_->plan, op, convolutions_[op.layer.id]);
}

void Program::record(const ops::MaxPool& op) { record_max_pool(work_->plan, op); }

void Program::record(const ops::AddUpsampled& op) { record_add_upsampled(work_->plan, op); }

void Program::record(const ops::Copy& op) {
  assert(op.from.rows == op.to.rows && op.from.columns == op.to.columns);
  work_->plan.copy(op.from, op.to);
}

Result<void> Program::compile() {
  Device& device = *work_->device;
  const bool keeps = !options_.pipeline_cache.empty();
  if (keeps) load_pipelines(device, options_.pipeline_cache);
  int compiled = 0;
  auto kernels = device.kernels(work_->plan.kernels(), &compiled);
  if (!kernels) return kernels.error();
  work_->compiled.kernels = *std::move(kernels);
  if (keeps && compiled > 0) store_pipelines(device, options_.pipeline_cache);

  auto descriptors = Descriptors::create(device, work_->plan, work_->compiled.kernels);
  if (!descriptors) return descriptors.error();
  work_->compiled.descriptors = *std::move(descriptors);
  return {};
}

Result<void> Program::record_commands() {
  const Device& device = *work_->device;
  const auto stamps = static_cast<std::uint32_t>(stage_names(work_->plan).size() + 1);
  auto timestamps = Timestamps::create(device, stamps);
  if (!timestamps) return timestamps.error();
  work_->timestamps = *std::move(timestamps);
  const auto commands = work_->submission.begin(device, "run");
  if (!commands) return commands.error();
  record_run(device, work_->plan, work_->compiled, work_->timestamps, *commands);
  work_->commands = *commands;
  return Submission::end(device, *commands);
}

void Program::fill_params(bool plausible) {
  const ops::FrameParams params{.fx = 1,
                                .fy = 1,
                                .cx = 0,
                                .cy = 0,
                                .width = 1,
                                .height = 1,
                                .field_width = 1,
                                .field_height = 1,
                                .point_count = kWarmUpPoints,
                                .centroid_x = 0,
                                .centroid_y = 0,
                                .centroid_z = 0,
                                .reserved0 = 0,
                                .reserved1 = 0,
                                .reserved2 = 0,
                                .reserved3 = 0};
  for (const ops::Tensor& tensor : params_) {
    if (work_->plan.resources().home(tensor.id) != Home::kInput) continue;
    const std::span<float> values = work_->plan.resources().host(tensor.id);
    if (plausible && values.size_bytes() >= sizeof(params)) {
      std::memcpy(values.data(), &params, sizeof(params));
    } else {
      std::fill(values.begin(), values.end(), 0.0F);
    }
  }
}

Result<void> Program::warm_up() {
  Device& device = *work_->device;
  const auto commands = work_->submission.begin(device, "warm-up");
  if (!commands) return commands.error();
  auto staging = work_->plan.resources().record_upload(device, *commands);
  if (!staging) return staging.error();
  work_->staging = *std::move(staging);
  record_warm_up(device, work_->plan, work_->compiled, *commands);
  const auto ended = Submission::end(device, *commands);
  if (!ended) return ended.error();

  fill_params(true);
  const auto flushed = work_->plan.resources().flush_inputs(device);
  if (!flushed) return flushed.error();
  const int timeout_ms = std::max(options_.timeout_ms, kShortestBuildTimeout_ms);
  const auto warmed = work_->submission.run(device, *commands, timeout_ms);
  if (!warmed) return warmed.error();
  fill_params(false);
  work_->staging = {};
  return {};
}

Result<void> Program::build() {
  assert(!built_);
  if (lost_) return *lost_;
  if (!work_->plan.faults().empty()) {
    std::string text;
    for (const std::string& fault : work_->plan.faults()) {
      if (!text.empty()) text += "\n";
      text += fault;
    }
    return Error{ErrorCode::kInternal, text};
  }
  if (options_.inspect) {
    options_.inspect(work_->plan);
    return {};
  }
  const auto allocated = work_->plan.resources().allocate(*work_->device);
  if (!allocated) return allocated.error();
  const auto compiled = compile();
  if (!compiled) return compiled.error();
  auto submission = Submission::create(*work_->device);
  if (!submission) return submission.error();
  work_->submission = *std::move(submission);
  const auto recorded = record_commands();
  if (!recorded) return recorded.error();
  const auto warmed = warm_up();
  if (!warmed) {
    lost_ = warmed.error();
    return warmed.error();
  }
  built_ = true;
  for (const auto& [input, values] : early_writes_) write(input, values);
  early_writes_.clear();
  return {};
}

void Program::write(ops::Tensor input, std::span<const float> values) {
  assert(work_->plan.resources().home(input.id) == Home::kInput);
  if (lost_) return;  // a device that may still be reading is not written to
  if (!built_) {
    early_writes_.emplace_back(input, std::vector<float>(values.begin(), values.end()));
    return;
  }
  const std::span<float> target = work_->plan.resources().host(input.id);
  assert(values.size() <= target.size());
  std::copy_n(values.begin(), std::min(values.size(), target.size()), target.begin());
}

Result<void> Program::run() {
  if (lost_) return *lost_;
  if (!built_) return Error{ErrorCode::kInternal, "Program: expected build() before run()"};
  const auto start = std::chrono::steady_clock::now();
  const Resources& resources = work_->plan.resources();
  auto done = resources.flush_inputs(*work_->device);
  if (done) done = work_->submission.run(*work_->device, work_->commands, options_.timeout_ms);
  if (done) done = resources.invalidate_outputs(*work_->device);
  if (!done) {
    lost_.emplace(Error{ErrorCode::kDeviceLost, {}});  // first: a copy of the words may fail
    lost_->message = done.error().message;
    return *lost_;
  }
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  host_ms_ = elapsed.count();
  return {};
}

void Program::read(ops::Tensor output, std::span<float> values) const {
  assert(built_ && work_->plan.resources().home(output.id) == Home::kOutput);
  if (!built_) return;
  const std::span<float> source = work_->plan.resources().host(output.id);
  assert(values.size() <= source.size());
  std::copy_n(source.begin(), std::min(values.size(), source.size()), values.begin());
}

std::vector<std::pair<std::string, double>> Program::stage_times_ms() const {
  if (!built_ || lost_) return {};
  const std::vector<double> intervals = work_->timestamps.intervals_ms(*work_->device);
  if (intervals.empty()) return {{"total", host_ms_}};
  const std::vector<std::string> names = stage_names(work_->plan);
  std::vector<std::pair<std::string, double>> times;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == 0 && names.size() > 1) continue;  // nothing happens before the first mark
    const auto known = std::find_if(times.begin(), times.end(),
                                    [&](const auto& entry) { return entry.first == names[i]; });
    if (known == times.end()) {
      times.emplace_back(names[i], intervals[i]);
    } else {
      known->second += intervals[i];
    }
  }
  return times;
}

}  // namespace flowdlo::vulkan
