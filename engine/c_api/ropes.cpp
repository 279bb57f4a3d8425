// The C interface to several ropes, hints and streams: checks, and calls of the C++ one.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "c_api/answers.hpp"
#include "c_api/arguments.hpp"
#include "c_api/handles.hpp"
#include "c_api/images.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"

namespace flowdlo::c_api {
namespace {

flowdlo_hints default_hints() {
  flowdlo_hints hints{};
  hints.struct_size = sizeof(hints);
  return hints;
}

flowdlo_tracking default_tracking() {
  const TrackerConfig defaults;
  return {.struct_size = sizeof(flowdlo_tracking),
          .most_moved_m = defaults.most_moved_m,
          .patience = defaults.patience,
          .reserved = 0};
}

/// Pixels are those of the region of interest, as the frame is.
Result<std::optional<Place>> place_of(const flowdlo_place& given, const flowdlo_frame& frame,
                                      const char* name) {
  switch (given.kind) {
    case FLOWDLO_PLACE_NONE:
      return std::optional<Place>{};
    case FLOWDLO_PLACE_PIXEL:
      return std::optional<Place>{Pixel{given.at[0] - static_cast<float>(frame.roi_u),
                                        given.at[1] - static_cast<float>(frame.roi_v)}};
    case FLOWDLO_PLACE_POINT:
      return std::optional<Place>{Point3{given.at[0], given.at[1], given.at[2]}};
    default:
      return Error{
          ErrorCode::kBadInput,
          fmt::format("flowdlo_hints.{}.kind: expected one of FLOWDLO_PLACE_, got {}; fill "
                      "the struct with flowdlo_hints_init before use",
                      name, given.kind)};
  }
}

Result<Hints> hints_of(const flowdlo_hints& given, const flowdlo_frame& frame) {
  Hints hints;
  if (given.previous != nullptr) {
    hints.previous.emplace();
    const float* from = given.previous;
    for (Point3& node : *hints.previous) {
      node = {from[0], from[1], from[2]};
      from += 3;
    }
  }
  if (given.rope_length_m != 0) hints.rope_length_m = given.rope_length_m;
  if (given.closed < -1 || given.closed > 1) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_hints.closed: expected 1, -1 or 0, got {}; fill the struct "
                             "with flowdlo_hints_init before use",
                             given.closed)};
  }
  if (given.closed != 0) hints.closed = given.closed > 0;
  auto first = place_of(given.first_end, frame, "first_end");
  if (!first) return first.error();
  hints.first_end = *first;
  for (const flowdlo_place& end : given.ends) {
    const auto place = place_of(end, frame, "ends");
    if (!place) return place.error();
    if (*place) hints.ends.push_back(**place);
  }
  return hints;
}

/// One rope, by `estimate` of a frame and its hints.
template <class Call>
Result<void> one_rope(flowdlo_estimator* estimator, const flowdlo_frame* given,
                      const flowdlo_hints* known, flowdlo_estimate* out, const char* who,
                      const Call& estimate) {
  const std::string name = fmt::format("{}: estimator", who);
  if (const auto there = check_there(estimator, name.c_str()); !there) return there.error();
  estimator->clear();
  if (const auto fits = check_size(given); !fits) return fits.error();
  if (const auto fits = check_size(out); !fits) return fits.error();
  flowdlo_hints said = default_hints();
  if (known != nullptr) {
    if (const auto fits = check_size(known); !fits) return fits.error();
    said = read(known, said);
  }
  const flowdlo_frame images = read(given, default_frame());
  const auto frame = frame_of(images, estimator->copies);
  if (!frame) return frame.error();
  const auto hints = hints_of(said, images);
  if (!hints) return hints.error();
  auto result = estimate(*frame, *hints);
  if (!result) return result.error();
  write(out, out->struct_size, plain(*result));
  estimator->alternatives = std::move(result->alternatives);
  return {};
}

/// Several ropes, by `estimate` of a frame, which leaves them with the estimator.
template <class Call>
Result<void> several_ropes(flowdlo_estimator* estimator, const flowdlo_frame* given,
                           std::int32_t* ropes, std::int32_t* crossings, const char* who,
                           const Call& estimate) {
  const std::string name = fmt::format("{}: estimator", who);
  if (const auto there = check_there(estimator, name.c_str()); !there) return there.error();
  estimator->clear();
  const std::string of_ropes = fmt::format("{}: ropes", who);
  if (const auto there = check_there(ropes, of_ropes.c_str()); !there) return there.error();
  if (const auto fits = check_size(given); !fits) return fits.error();
  const auto frame = frame_of(read(given, default_frame()), estimator->copies);
  if (!frame) return frame.error();
  if (auto done = estimate(*frame); !done) return done.error();
  estimator->alternatives = estimator->ropes.ropes.front().alternatives;
  *ropes = static_cast<std::int32_t>(estimator->ropes.ropes.size());
  if (crossings != nullptr) {
    *crossings = static_cast<std::int32_t>(estimator->ropes.crossings.size());
  }
  return {};
}

Result<void> track_ropes(flowdlo_estimator* estimator, const flowdlo_frame* given,
                         std::int32_t* ropes, std::int32_t* crossings, std::int32_t* missing) {
  auto done = several_ropes(estimator, given, ropes, crossings, "flowdlo_estimator_track_ropes",
                            [&](const Frame& frame) -> Result<void> {
                              auto result = estimator->tracker.estimate_ropes(frame);
                              if (!result) return result.error();
                              estimator->ropes = std::move(result->found);
                              estimator->numbers = std::move(result->numbers);
                              estimator->missing = std::move(result->missing);
                              return {};
                            });
  if (done && missing != nullptr) *missing = static_cast<std::int32_t>(estimator->missing.size());
  return done;
}

Result<void> set_tracking(flowdlo_estimator* estimator, const flowdlo_tracking* given) {
  if (const auto there = check_there(estimator, "flowdlo_estimator_set_tracking: estimator");
      !there) {
    return there.error();
  }
  if (const auto fits = check_size(given); !fits) return fits.error();
  const flowdlo_tracking said = read(given, default_tracking());
  if (said.reserved != 0) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_tracking.reserved: expected 0, got {}; fill the struct with "
                             "flowdlo_tracking_init before use",
                             said.reserved)};
  }
  return estimator->tracker.configure(
      {.most_moved_m = said.most_moved_m, .patience = said.patience});
}

/// The one at `index` of the numbers that the last tracked frame left.
Result<void> number_of(const std::vector<int>& all, std::int32_t index, const char* who,
                       std::int32_t* out) {
  const std::string name = fmt::format("{}: number", who);
  if (const auto there = check_there(out, name.c_str()); !there) return there.error();
  if (index < 0 || static_cast<std::size_t>(index) >= all.size()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: index: expected 0 or more and below the {} of the last "
                             "flowdlo_estimator_track_ropes, got {}",
                             who, all.size(), index)};
  }
  *out = all[static_cast<std::size_t>(index)];
  return {};
}

/// Writes the one at `index` of `all`, which the last estimate of several ropes left.
template <class Value, class Struct>
Result<void> one_of(const std::vector<Value>& all, std::int32_t index, const char* who,
                    Struct* out) {
  if (const auto fits = check_size(out); !fits) return fits.error();
  if (index < 0 || static_cast<std::size_t>(index) >= all.size()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: index: expected 0 or more and below the {} of the last "
                             "flowdlo_estimator_estimate_ropes, got {}",
                             who, all.size(), index)};
  }
  write(out, out->struct_size, plain(all[static_cast<std::size_t>(index)]));
  return {};
}

Result<void> instances(const flowdlo_estimator* estimator, std::uint16_t* out, std::size_t count) {
  if (const auto there = check_there(estimator, "flowdlo_estimator_instances: estimator"); !there) {
    return there.error();
  }
  if (const auto there = check_there(out, "flowdlo_estimator_instances: instances"); !there) {
    return there.error();
  }
  const auto& all = estimator->ropes.instances;
  if (all.empty() || count != all.size()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_estimator_instances: count: expected the {} pixels of the "
                             "last flowdlo_estimator_estimate_ropes, got {}",
                             all.size(), count)};
  }
  std::copy(all.begin(), all.end(), out);
  return {};
}

}  // namespace
}  // namespace flowdlo::c_api

namespace guard = flowdlo::guard;
namespace c_api = flowdlo::c_api;

flowdlo_status flowdlo_hints_init(flowdlo_hints* hints, size_t struct_size) {
  return c_api::initialise(hints, struct_size, c_api::default_hints());
}

flowdlo_status flowdlo_tracking_init(flowdlo_tracking* tracking, size_t struct_size) {
  return c_api::initialise(tracking, struct_size, c_api::default_tracking());
}

flowdlo_status flowdlo_crossing_init(flowdlo_crossing* crossing, size_t struct_size) {
  return c_api::initialise(crossing, struct_size, flowdlo_crossing{});
}

flowdlo_status flowdlo_estimator_estimate_with_hints(flowdlo_estimator* estimator,
                                                     const flowdlo_frame* frame,
                                                     const flowdlo_hints* hints,
                                                     flowdlo_estimate* estimate) {
  return c_api::told(guard::guarded("flowdlo_estimator_estimate_with_hints", [&] {
    return c_api::one_rope(estimator, frame, hints, estimate,
                           "flowdlo_estimator_estimate_with_hints",
                           [&](const flowdlo::Frame& images, const flowdlo::Hints& known) {
                             return estimator->estimator().estimate(images, known);
                           });
  }));
}

flowdlo_status flowdlo_estimator_estimate_ropes(flowdlo_estimator* estimator,
                                                const flowdlo_frame* frame, int32_t* ropes,
                                                int32_t* crossings) {
  return c_api::told(guard::guarded("flowdlo_estimator_estimate_ropes", [&] {
    return c_api::several_ropes(estimator, frame, ropes, crossings,
                                "flowdlo_estimator_estimate_ropes",
                                [&](const flowdlo::Frame& images) -> flowdlo::Result<void> {
                                  auto result = estimator->estimator().estimate_ropes(images);
                                  if (!result) return result.error();
                                  estimator->ropes = *std::move(result);
                                  return {};
                                });
  }));
}

flowdlo_status flowdlo_estimator_rope(const flowdlo_estimator* estimator, int32_t index,
                                      flowdlo_estimate* estimate) {
  return c_api::told(guard::guarded("flowdlo_estimator_rope", [&]() -> flowdlo::Result<void> {
    const auto there = c_api::check_there(estimator, "flowdlo_estimator_rope: estimator");
    if (!there) return there.error();
    return c_api::one_of(estimator->ropes.ropes, index, "flowdlo_estimator_rope", estimate);
  }));
}

flowdlo_status flowdlo_estimator_crossing(const flowdlo_estimator* estimator, int32_t index,
                                          flowdlo_crossing* crossing) {
  return c_api::told(guard::guarded("flowdlo_estimator_crossing", [&]() -> flowdlo::Result<void> {
    const auto there = c_api::check_there(estimator, "flowdlo_estimator_crossing: estimator");
    if (!there) return there.error();
    return c_api::one_of(estimator->ropes.crossings, index, "flowdlo_estimator_crossing", crossing);
  }));
}

flowdlo_status flowdlo_estimator_instances(const flowdlo_estimator* estimator, uint16_t* instances,
                                           size_t count) {
  return c_api::told(guard::guarded("flowdlo_estimator_instances",
                                    [&] { return c_api::instances(estimator, instances, count); }));
}

flowdlo_status flowdlo_estimator_set_tracking(flowdlo_estimator* estimator,
                                              const flowdlo_tracking* tracking) {
  return c_api::told(guard::guarded("flowdlo_estimator_set_tracking",
                                    [&] { return c_api::set_tracking(estimator, tracking); }));
}

flowdlo_status flowdlo_estimator_track(flowdlo_estimator* estimator, const flowdlo_frame* frame,
                                       const flowdlo_hints* hints, flowdlo_estimate* estimate) {
  return c_api::told(guard::guarded("flowdlo_estimator_track", [&] {
    return c_api::one_rope(estimator, frame, hints, estimate, "flowdlo_estimator_track",
                           [&](const flowdlo::Frame& images, const flowdlo::Hints& known) {
                             return estimator->tracker.estimate(images, known);
                           });
  }));
}

flowdlo_status flowdlo_estimator_track_ropes(flowdlo_estimator* estimator,
                                             const flowdlo_frame* frame, int32_t* ropes,
                                             int32_t* crossings, int32_t* missing) {
  return c_api::told(guard::guarded("flowdlo_estimator_track_ropes", [&] {
    return c_api::track_ropes(estimator, frame, ropes, crossings, missing);
  }));
}

flowdlo_status flowdlo_estimator_rope_number(const flowdlo_estimator* estimator, int32_t index,
                                             int32_t* number) {
  return c_api::told(
      guard::guarded("flowdlo_estimator_rope_number", [&]() -> flowdlo::Result<void> {
        const auto there =
            c_api::check_there(estimator, "flowdlo_estimator_rope_number: estimator");
        if (!there) return there.error();
        return c_api::number_of(estimator->numbers, index, "flowdlo_estimator_rope_number", number);
      }));
}

flowdlo_status flowdlo_estimator_missing_rope(const flowdlo_estimator* estimator, int32_t index,
                                              int32_t* number) {
  return c_api::told(
      guard::guarded("flowdlo_estimator_missing_rope", [&]() -> flowdlo::Result<void> {
        const auto there =
            c_api::check_there(estimator, "flowdlo_estimator_missing_rope: estimator");
        if (!there) return there.error();
        return c_api::number_of(estimator->missing, index, "flowdlo_estimator_missing_rope",
                                number);
      }));
}

flowdlo_status flowdlo_estimator_forget(flowdlo_estimator* estimator) {
  return c_api::told(guard::guarded("flowdlo_estimator_forget", [&]() -> flowdlo::Result<void> {
    const auto there = c_api::check_there(estimator, "flowdlo_estimator_forget: estimator");
    if (!there) return there.error();
    estimator->tracker.forget();
    return {};
  }));
}
