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

struct VulkanFrame;  // <flowdlo/vulkan.hpp>
struct VulkanHost;

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

  /// On a Vulkan device that the caller made and keeps, and that outlives the estimator: see
  /// VulkanHost. Fails as well with kNoDevice, naming everything that the device lacks. Of
  /// Config::device, "auto": the device is taken once its self-test passes, else this fails with
  /// kNoDevice; where it is lost later, the CPU takes its place for good. "vulkan": it is taken
  /// untested, and its loss is kDeviceLost. Anything else is kBadInput. Config::probe and
  /// Config::validation have no effect.
  [[nodiscard]] static Result<Estimator> create(const Config& config, const VulkanHost& host);

  /// Fails with kBadInput, kNoEvidence, kNoPath, kDeviceLost or kOutOfMemory; never throws. A
  /// rejected prediction is not a failure: the estimate is then the prior, with Source::kPrior.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame);

  /// The same, and copies every tensor of spec section 3 (`--tensors`) to `tensors`.
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, Tensors& tensors);

  /// With what the caller knows beside the frame. Fails as well with kBadInput, naming every fault
  /// of `hints`. Without any hint the same bits as estimate(frame).
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints);
  [[nodiscard]] Result<Estimate> estimate(const Frame& frame, const Hints& hints, Tensors& tensors);

  /// The frame in buffers of the host's device, as views into this estimator's memory that are good
  /// until the next fetch() or the estimator's end: for every estimate below and above. Waits for
  /// what the frame waits for, at most Config::device_timeout_ms; what takes longer is kDeviceLost.
  /// Fails as well with kBadInput, naming every fault of `frame`, also where the estimator was made
  /// without a host's device; and with kOutOfMemory.
  [[nodiscard]] Result<Frame> fetch(const VulkanFrame& frame);

  /// estimate() of fetch(): the same bits as of the same frame in the caller's memory. What fetch()
  /// takes is in none of the timings.
  [[nodiscard]] Result<Estimate> estimate(const VulkanFrame& frame);

  /// Each rope of the frame on its own: Config::ropes of them, or one for each label that
  /// Frame::instances has on the mask. Takes as long as estimate() for each; Config::budget_ms is
  /// for all of them. Without labels the rope is that of estimate() where Config::ropes is 1, and
  /// where it is 0 and the mask shows one that is no ring.
  /// Fails as estimate() does, and with kNoPath where there are more than kMostRopes, or fewer than
  /// asked for.
  [[nodiscard]] Result<Ropes> estimate_ropes(const Frame& frame);

  /// The same by heed of the ropes of the frame before, as Tracker::estimate_ropes has it: of sets
  /// of ropes that the frame hardly tells apart the one is taken that has them. A rope
  /// that a label tells apart has the nearest for Hints::previous, an only rope the only one. Those
  /// that lie elsewhere by more than a width and a half are no evidence, nor is what has a node
  /// that is not finite. `confidence` stays what the frame alone says.
  [[nodiscard]] Result<Ropes> estimate_ropes(const Frame& frame,
                                             const std::vector<KnownRope>& before);

  /// "cpu", or the name of the Vulkan device in use. With Config::device "auto" a lost device is
  /// followed by "cpu"; a device is tried again after 1 s, 2 s, 4 s and so on up to 5 minutes, on a
  /// thread of its own, and taken for the next frame once its self-test passes. Moved from: empty.
  [[nodiscard]] const std::string& device() const;

  /// The same of the strand field's network, which Config::field_device places; empty where there
  /// is none.
  [[nodiscard]] const std::string& field_device() const;

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
  [[nodiscard]] FLOWDLO_HIDDEN static Result<Estimator> make(const Config& config,
                                                             const VulkanHost* host);
  FLOWDLO_HIDDEN explicit Estimator(std::unique_ptr<Impl> impl);
  FLOWDLO_HIDDEN Result<Estimate> run(const Frame& frame, const Hints& hints, Tensors* tensors);
  [[nodiscard]] FLOWDLO_HIDDEN Result<void> usable() const;
  std::unique_ptr<Impl, LetGo> impl_;
};

}  // namespace flowdlo
