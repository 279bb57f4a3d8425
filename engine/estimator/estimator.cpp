// Estimator: the one file that sees every room. Chapter 3 of the thesis, Figure 3.1.
#include "flowdlo/estimator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <vector>

#include "estimator/confidence.hpp"
#include "estimator/device_choice.hpp"
#include "estimator/tensors.hpp"
#include "estimator/weights_location.hpp"
#include "evidence/mask_field.hpp"
#include "evidence/visible_points.hpp"
#include "flow/sampler.hpp"
#include "gate/gate.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"
#include "weights/weights.hpp"

namespace flowdlo {
namespace {

/// Adds the time since the last lap to one of the caller's figures.
class Stopwatch {
 public:
  void lap(double& total_ms) {
    const auto now = Clock::now();
    total_ms += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

Result<void> check(const Config& config) {
  std::string faults;
  const auto expect = [&](bool fine, const char* field, const char* expected, int got) {
    if (fine) return;
    faults += fmt::format("{}Config.{}: expected {}, got {}", faults.empty() ? "" : "\n", field,
                          expected, got);
  };
  expect(config.euler_steps >= 1 && config.euler_steps <= 64, "euler_steps", "1 to 64",
         config.euler_steps);
  expect(config.draws >= 1 && config.draws <= 64, "draws", "1 to 64", config.draws);
  expect(config.threads >= 0 && config.threads <= 1024, "threads", "0 to 1024", config.threads);
  expect(config.max_width >= 1 && config.max_width <= 4096, "max_width", "1 to 4096",
         config.max_width);
  expect(config.max_height >= 1 && config.max_height <= 4096, "max_height", "1 to 4096",
         config.max_height);
  expect(config.device_timeout_ms >= 1, "device_timeout_ms", "at least 1",
         config.device_timeout_ms);
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

/// A rope rarely covers more of an image than this; a denser mask makes the sampler grow once.
constexpr int kCloudShare = 4;

flow::SamplerConfig sampler_config(const Config& config) {
  const int pixels = config.max_width * config.max_height;
  return {.draws = config.draws,
          .steps = config.euler_steps,
          .seed = config.seed,
          .capacity = {.cloud_points = pixels / kCloudShare,
                       .field_texels = pixels / 4,
                       .image_pixels = pixels}};
}

}  // namespace

struct Estimator::Impl {
  Config config;
  std::shared_ptr<const weights::Weights> weights;
  std::string device;
  flow::Sampler sampler;

  Result<Estimate> estimate(const Frame& frame, Tensors* tensors);
  Result<flow::Prediction> sample(const flow::SampleInput& input);
};

Result<Estimator> Estimator::create(const Config& config) {
  if (auto checked = check(config); !checked) return checked.error();
  auto file = config.weights.empty() ? estimator::default_weights()
                                     : Result<std::filesystem::path>(config.weights);
  if (!file) return file.error();
  auto loaded = weights::load(*file);
  if (!loaded) return loaded.error();
  const auto weights = std::make_shared<const weights::Weights>(*std::move(loaded));

  auto back_end = estimator::choose_back_end(config);
  if (!back_end) return back_end.error();
  auto sampler = flow::Sampler::create(weights, back_end->make_program, sampler_config(config));
  if (!sampler) return sampler.error();
  return Estimator(
      std::make_unique<Impl>(Impl{config, weights, back_end->name, *std::move(sampler)}));
}

/// The model's predictions. Where the device was left to us, a lost one is replaced by the CPU.
Result<flow::Prediction> Estimator::Impl::sample(const flow::SampleInput& input) {
  auto prediction = sampler.sample(input);
  if (prediction || config.device != "auto" || device == "cpu") return prediction;
  const auto cpu = estimator::cpu_back_end(config.threads);
  auto replacement = flow::Sampler::create(weights, cpu.make_program, sampler_config(config));
  if (!replacement) return prediction;
  sampler = *std::move(replacement);
  device = cpu.name;
  return sampler.sample(input);
}

Result<Estimate> Estimator::Impl::estimate(const Frame& frame, Tensors* tensors) {
  if (auto valid = validate(frame); !valid) return valid.error();
  Estimate estimate;
  Timings& timings = estimate.timings;
  Stopwatch total;
  Stopwatch stage;

  const auto cloud = evidence::unproject(frame);  // Sec. 3.2
  if (cloud.points_cam.empty()) {
    return Error{ErrorCode::kNoEvidence,
                 "Frame: expected depth on the mask, got no mask pixel with a depth above 1e-6 m; "
                 "check the mask, and that depth is in metres and aligned to it"};
  }
  const auto visible = evidence::visible_points(cloud);
  stage.lap(timings.evidence_ms);

  const auto paths = path::trace(frame, {});  // Sec. 3.3
  stage.lap(timings.path_ms);
  if (!paths) return paths.error();

  const auto prior = prior::lift(paths->ranked.front(), visible, frame);  // Eq. (3.1)-(3.7)
  if (!prior) return prior.error();
  const std::vector<prior::Prior> draw_priors(static_cast<std::size_t>(config.draws), *prior);
  stage.lap(timings.prior_ms);

  const auto field = evidence::mask_field(frame);
  stage.lap(timings.mask_field_ms);

  const auto prediction = sample(  // Eq. (3.26)-(3.29)
      {.frame = frame, .cloud = cloud, .field = field, .draw_priors = draw_priors});
  if (!prediction) return prediction.error();
  timings.device_ms = sampler.stage_times_ms();
  stage.lap(timings.model_ms);

  const gate::DilatedMask mask(frame);
  const std::vector<Centerline> prior_nodes(draw_priors.size(), prior->nodes);
  auto verdict = gate::choose(prediction->draws, prior_nodes, prior->nodes, mask,
                              frame.intrinsics);  // Eq. (3.30)-(3.33)
  estimate.source = verdict.source;
  estimate.draw = verdict.draw;
  estimate.nodes =
      verdict.draw >= 0 ? prediction->draws[static_cast<std::size_t>(verdict.draw)] : prior->nodes;
  estimate.support = prior->support;
  estimate.sigma_m = estimator::node_sigma(verdict.source, verdict.draw, *prediction, *prior);
  estimate.mask_agreement = mask.agreement(estimate.nodes, frame.intrinsics);
  estimate.prior_mask_agreement = verdict.prior_agreement;
  estimate.confidence =
      estimator::confidence(estimate.mask_agreement, paths->margin, estimate.support);
  estimate.draws = std::move(verdict.draws);
  for (std::size_t i = 1; i < paths->ranked.size(); ++i) {
    const auto lifted = prior::lift(paths->ranked[i], visible, frame);
    if (!lifted) continue;
    estimate.alternatives.push_back({lifted->nodes, static_cast<float>(paths->ranked[i].score),
                                     mask.agreement(lifted->nodes, frame.intrinsics)});
  }
  stage.lap(timings.gate_ms);
  total.lap(timings.total_ms);

  if (tensors != nullptr) {
    *tensors = estimator::collect_tensors(sampler.source(), paths->ranked.front(), draw_priors,
                                          *prediction, field);
  }
  return estimate;
}

Result<Estimate> Estimator::estimate(const Frame& frame) { return impl_->estimate(frame, nullptr); }

Result<Estimate> Estimator::estimate(const Frame& frame, Tensors& tensors) {
  return impl_->estimate(frame, &tensors);
}

const std::string& Estimator::device() const { return impl_->device; }

Estimator::Estimator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;
Estimator::~Estimator() = default;

}  // namespace flowdlo
