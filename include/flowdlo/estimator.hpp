// Estimator: frame in, centerline out.
#pragma once

#include <memory>
#include <string>

#include "flowdlo/config.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// Owns the device and the weights; create once, call per frame. One instance a thread: a call
/// reuses its buffers. Calls on different instances may run at the same time. It belongs to the
/// process that made it: in one that was forked from there it may be destroyed, and estimate()
/// fails. An instance that was moved from fails as well, and answers nothing but that.
class FLOWDLO_EXPORT Estimator {
 public:
  /// Fails with kBadInput, kBadWeights, kIo, kNoDevice, kDeviceLost or kOutOfMemory; with
  /// Config::device "auto" never for a device's sake. The only call that reads files or compiles,
  /// but for what "auto" does beside the frames after it lost a device.
  [[nodiscard]] static Result<Estimator> create(const Config& config);

  /// Fails with kBadInput, kNoEvidence, kNoPath, kDeviceLost or kOutOfMemory; never throws. A
  /// rejected prediction is not a failure: the estimate is then the prior, with Source::kPrior.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame);

  /// The same, and copies every tensor of spec section 3 (`--tensors`) to `tensors`.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, Tensors& tensors);

  /// With what the caller knows beside the frame. Fails as well with kBadInput, naming every fault
  /// of `hints`. Without any hint the same bits as estimate(frame).
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints);
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints, Tensors& tensors);

  /// Each rope of the frame on its own: Config::ropes of them, or one for each label that
  /// Frame::instances has on the mask. Takes as long as estimate() for each; Config::budget_ms is
  /// for all of them. With Config::ropes = 1 and no labels the one rope is that of estimate().
  /// Fails as estimate() does, and with kNoPath where there are more than kMostRopes, or fewer than
  /// asked for.
  [[nodiscard]] Result<Ropes> estimate_ropes(const Frame& frame);

  /// "cpu", or the name of the Vulkan device in use. With Config::device "auto" a lost device is
  /// followed by "cpu"; a device is tried again after 1 s, 2 s, 4 s and so on up to 5 minutes, on a
  /// thread of its own, and taken for the next frame once its self-test passes. Moved from: empty.
  [[nodiscard]] const std::string& device() const;

  /// K and D in use: Config's, or those that Quality::kFast stands for. Moved from: 0.
  [[nodiscard]] int euler_steps() const;
  [[nodiscard]] int draws() const;

  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  ~Estimator();

 private:
  struct Impl;
  struct FLOWDLO_HIDDEN LetGo {
    void operator()(Impl* impl) const noexcept;
  };
  FLOWDLO_HIDDEN explicit Estimator(std::unique_ptr<Impl> impl);
  FLOWDLO_HIDDEN Result<Estimate> run(const Frame& frame, const Hints& hints, Tensors* tensors);
  [[nodiscard]] FLOWDLO_HIDDEN Result<void> usable() const;
  std::unique_ptr<Impl, LetGo> impl_;
};

}  // namespace flowdlo
