// Estimator: frame in, centerline out.
#pragma once

#include <memory>
#include <string>

#include "flowdlo/config.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// Owns the device and the weights; create once, call per frame. One instance a thread: a call
/// reuses its buffers. Calls on different instances may run at the same time.
class FLOWDLO_EXPORT Estimator {
 public:
  /// Fails with kBadInput, kBadWeights or kNoDevice. The only call that reads files or compiles.
  [[nodiscard]] static Result<Estimator> create(const Config& config);

  /// Fails with kBadInput, kNoEvidence, kNoPath or kDeviceLost; never throws. A rejected
  /// prediction is not a failure: the estimate is then the prior, with Source::kPrior.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame);

  /// The same, and copies every tensor of spec section 3 (`--tensors`) to `tensors`.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, Tensors& tensors);

  /// "cpu", or the name of the Vulkan device in use.
  [[nodiscard]] const std::string& device() const;

  /// K and D in use: Config's, or those that Quality::kFast stands for.
  [[nodiscard]] int euler_steps() const;
  [[nodiscard]] int draws() const;

  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  ~Estimator();

 private:
  struct Impl;
  FLOWDLO_HIDDEN explicit Estimator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo
