// Tracker: an estimator and what it saw in the frame before.
#include "flowdlo/tracker.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "guard/guarded.hpp"
#include "track/known_ropes.hpp"

namespace flowdlo {
namespace {

Result<void> check(const TrackerConfig& config) {
  std::string faults;
  if (!(std::isfinite(config.most_moved_m) && config.most_moved_m > 0)) {
    faults = fmt::format("TrackerConfig.most_moved_m: expected metres over 0, got {}",
                         config.most_moved_m);
  }
  if (config.patience < 0) {
    if (!faults.empty()) faults += '\n';
    faults +=
        fmt::format("TrackerConfig.patience: expected 0 or more frames, got {}", config.patience);
  }
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

}  // namespace

struct FLOWDLO_HIDDEN Tracker::Impl {
  Estimator estimator;
  track::KnownRopes ropes;
  std::optional<Centerline> previous{};  ///< of the one rope
  int failed = 0;                        ///< frames in a row since then

  void forget() {
    ropes.forget();
    previous.reset();
    failed = 0;
  }
};

Result<Tracker> Tracker::create(const Config& config, const TrackerConfig& tracking) {
  return guard::guarded("Tracker::create", [&]() -> Result<Tracker> {
    if (auto checked = check(tracking); !checked) return checked.error();
    auto estimator = Estimator::create(config);
    if (!estimator) return estimator.error();
    return create(*std::move(estimator), tracking);
  });
}

Result<Tracker> Tracker::create(Estimator estimator, const TrackerConfig& tracking) {
  return guard::guarded("Tracker::create", [&]() -> Result<Tracker> {
    if (auto checked = check(tracking); !checked) return checked.error();
    if (estimator.device().empty()) {
      return Error{ErrorCode::kBadInput,
                   "Tracker: expected an estimator in use, got one that was moved from; make a "
                   "new one"};
    }
    return Tracker(
        std::unique_ptr<Impl>(new Impl{std::move(estimator), track::KnownRopes(tracking)}));
  });
}

Result<Estimate> Tracker::run(const Frame& frame, const Hints& hints, Tensors* tensors) {
  return guard::guarded("Tracker::estimate", [&]() -> Result<Estimate> {
    if (auto fine = usable(); !fine) return fine.error();
    Hints known = hints;
    if (!known.previous) known.previous = impl_->previous;
    auto estimate = tensors != nullptr ? impl_->estimator.estimate(frame, known, *tensors)
                                       : impl_->estimator.estimate(frame, known);
    if (estimate) {
      impl_->previous = estimate->nodes;
      impl_->failed = 0;
    } else if (++impl_->failed > impl_->ropes.config().patience) {
      impl_->previous.reset();
    }
    return estimate;
  });
}

Result<Estimate> Tracker::estimate(const Frame& frame, const Hints& hints) {
  return run(frame, hints, nullptr);
}

Result<Estimate> Tracker::estimate(const Frame& frame, const Hints& hints, Tensors& tensors) {
  return run(frame, hints, &tensors);
}

Result<TrackedRopes> Tracker::estimate_ropes(const Frame& frame) {
  return guard::guarded("Tracker::estimate_ropes", [&]() -> Result<TrackedRopes> {
    if (auto fine = usable(); !fine) return fine.error();
    auto ropes = impl_->estimator.estimate_ropes(frame, impl_->ropes.last_seen());
    if (ropes) return impl_->ropes.recognise(*std::move(ropes));
    impl_->ropes.miss_all();
    return ropes.error();
  });
}

void Tracker::forget() {
  if (impl_) impl_->forget();
}

Result<void> Tracker::configure(const TrackerConfig& tracking) {
  return guard::guarded("Tracker::configure", [&]() -> Result<void> {
    if (auto fine = usable(); !fine) return fine.error();
    if (auto checked = check(tracking); !checked) return checked.error();
    impl_->ropes.configure(tracking);
    return {};
  });
}

Estimator* Tracker::estimator() { return impl_ ? &impl_->estimator : nullptr; }
const Estimator* Tracker::estimator() const { return impl_ ? &impl_->estimator : nullptr; }

Result<void> Tracker::usable() const {
  if (impl_) return {};
  return Error{ErrorCode::kBadInput,
               "Tracker: expected one in use, got one that was moved from; make a new one"};
}

Tracker::Tracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

}  // namespace flowdlo
