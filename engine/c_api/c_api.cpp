// The C interface: each function checks what it was given and calls the C++ one.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "c_api/answers.hpp"
#include "c_api/arguments.hpp"
#include "c_api/handles.hpp"
#include "c_api/images.hpp"
#include "c_api/last_error.hpp"
#include "c_api/sized.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"
#include "flowdlo/frame_folder.hpp"
#include "guard/guarded.hpp"

struct flowdlo_frame_folder {
  flowdlo::FrameFolder content;
};

namespace flowdlo::c_api {
namespace {

static_assert(FLOWDLO_NODES == kNodes);
static_assert(FLOWDLO_QUALITY_FAST == static_cast<int>(Quality::kFast));
static_assert(FLOWDLO_QUALITY_AUTO == static_cast<int>(Quality::kAuto));
static_assert(FLOWDLO_PRIOR_THESIS == static_cast<int>(PriorChoice::kThesis));
static_assert(FLOWDLO_PRIOR_REFINED == static_cast<int>(PriorChoice::kRefined));
static_assert(FLOWDLO_GATE_THESIS == static_cast<int>(GateChoice::kThesis));
static_assert(FLOWDLO_GATE_CALIBRATED == static_cast<int>(GateChoice::kCalibrated));
static_assert(FLOWDLO_FIELD_OFF == static_cast<int>(FieldChoice::kOff));
static_assert(FLOWDLO_FIELD_STRANDS == static_cast<int>(FieldChoice::kStrands));
static_assert(FLOWDLO_FIELD_DEVICE_CPU == static_cast<int>(FieldDevice::kCpu));
static_assert(FLOWDLO_FIELD_DEVICE_SAME == static_cast<int>(FieldDevice::kSame));
static_assert(FLOWDLO_SOURCE_PREDICTION == static_cast<int>(Source::kPrediction));
static_assert(FLOWDLO_SOURCE_PRIOR == static_cast<int>(Source::kPrior));
static_assert(FLOWDLO_ORIGIN_FIRST_PRIOR == static_cast<int>(Origin::kFirstPrior));
static_assert(FLOWDLO_ORIGIN_RUNNER_UP == static_cast<int>(Origin::kRunnerUp));
static_assert(FLOWDLO_ORIGIN_OTHER_READING == static_cast<int>(Origin::kOtherReading));
static_assert(FLOWDLO_ORIGIN_FRAME_BEFORE == static_cast<int>(Origin::kFrameBefore));
static_assert(FLOWDLO_ORIGIN_DRAW == static_cast<int>(Origin::kDraw));
static_assert(FLOWDLO_DOUBT_NO_ROPE == 1U << static_cast<int>(Doubt::kNoRope));
static_assert(FLOWDLO_DOUBT_STRANDS_LEFT == 1U << static_cast<int>(Doubt::kStrandsLeft));
static_assert(FLOWDLO_DOUBT_BARE_GAP == 1U << static_cast<int>(Doubt::kBareGap));
static_assert(FLOWDLO_DOUBT_GOES_ON == 1U << static_cast<int>(Doubt::kGoesOn));
static_assert(FLOWDLO_DOUBT_NO_DEPTH == 1U << static_cast<int>(Doubt::kNoDepth));
static_assert(FLOWDLO_LEFT_OUT_MODEL == 1U << static_cast<int>(LeftOut::kModel));
static_assert(FLOWDLO_LEFT_OUT_FIELD == 1U << static_cast<int>(LeftOut::kField));
static_assert(FLOWDLO_LEFT_OUT_READINGS == 1U << static_cast<int>(LeftOut::kReadings));

flowdlo_config default_config() {
  const Config defaults;
  return {.struct_size = sizeof(flowdlo_config),
          .weights = nullptr,
          .device = nullptr,
          .field_weights = nullptr,
          .seed = defaults.seed,
          .rope_length_m = defaults.rope_length_m,
          .quality = static_cast<std::int32_t>(defaults.quality),
          .euler_steps = defaults.euler_steps,
          .draws = defaults.draws,
          .prior = static_cast<std::int32_t>(defaults.prior),
          .gate = static_cast<std::int32_t>(defaults.gate),
          .field = static_cast<std::int32_t>(defaults.field),
          .threads = defaults.threads,
          .max_width = defaults.max_width,
          .max_height = defaults.max_height,
          .device_timeout_ms = defaults.device_timeout_ms,
          .validation = defaults.validation ? 1 : 0,
          .reserved = 0,
          .budget_ms = defaults.budget_ms,
          .probe = defaults.probe ? 1 : 0,
          .ropes = defaults.ropes,
          .field_device = static_cast<std::int32_t>(defaults.field_device),
          .reserved_2 = 0};
}

Config config_of(const flowdlo_config& given) {
  Config config;
  if (given.weights != nullptr) config.weights = given.weights;
  if (given.device != nullptr) config.device = given.device;
  if (given.field_weights != nullptr) config.field_weights = given.field_weights;
  config.seed = given.seed;
  config.rope_length_m = given.rope_length_m;
  config.quality = static_cast<Quality>(given.quality);
  config.euler_steps = given.euler_steps;
  config.draws = given.draws;
  config.prior = static_cast<PriorChoice>(given.prior);
  config.gate = static_cast<GateChoice>(given.gate);
  config.field = static_cast<FieldChoice>(given.field);
  config.threads = given.threads;
  config.max_width = given.max_width;
  config.max_height = given.max_height;
  config.device_timeout_ms = given.device_timeout_ms;
  config.validation = given.validation != 0;
  config.budget_ms = given.budget_ms;
  config.probe = given.probe != 0;
  config.ropes = given.ropes;
  config.field_device = static_cast<FieldDevice>(given.field_device);
  return config;
}

Result<void> create(const flowdlo_config* given, flowdlo_estimator** out) {
  if (const auto there = check_there(out, "flowdlo_estimator_create: estimator"); !there) {
    return there.error();
  }
  flowdlo_config config = default_config();
  if (given != nullptr) {
    if (const auto fits = check_size(given); !fits) return fits.error();
    config = read(given, config);
    for (const auto& [name, value] :
         {std::pair{"reserved", config.reserved}, std::pair{"reserved_2", config.reserved_2}}) {
      if (value == 0) continue;
      return Error{ErrorCode::kBadInput,
                   fmt::format("flowdlo_config.{}: expected 0, got {}; fill the struct with "
                               "flowdlo_config_init before use",
                               name, value)};
    }
  }
  auto tracker = Tracker::create(config_of(config));
  if (!tracker) return tracker.error();
  *out = std::make_unique<flowdlo_estimator>(flowdlo_estimator{*std::move(tracker)}).release();
  return {};
}

Result<void> estimate(flowdlo_estimator* estimator, const flowdlo_frame* given,
                      flowdlo_estimate* out) {
  if (const auto there = check_there(estimator, "flowdlo_estimator_estimate: estimator"); !there) {
    return there.error();
  }
  estimator->clear();
  if (const auto fits = check_size(given); !fits) return fits.error();
  if (const auto fits = check_size(out); !fits) return fits.error();
  const auto frame = frame_of(read(given, default_frame()), estimator->copies);
  if (!frame) return frame.error();
  auto result = estimator->estimator().estimate(*frame);
  if (!result) return result.error();
  write(out, out->struct_size, plain(*result));
  estimator->alternatives = std::move(result->alternatives);
  return {};
}

Result<void> alternative(const flowdlo_estimator* estimator, std::int32_t index,
                         flowdlo_alternative* out) {
  if (const auto there = check_there(estimator, "flowdlo_estimator_alternative: estimator");
      !there) {
    return there.error();
  }
  if (const auto fits = check_size(out); !fits) return fits.error();
  const auto& all = estimator->alternatives;
  if (index < 0 || static_cast<std::size_t>(index) >= all.size()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo_estimator_alternative: index: expected 0 or more and below "
                             "the {} of the last estimate, got {}",
                             all.size(), index)};
  }
  const Alternative& one = all[static_cast<std::size_t>(index)];
  flowdlo_alternative value{};
  copy_nodes(one.nodes, value.nodes);
  value.score = one.score;
  value.mask_agreement = one.mask_agreement;
  write(out, out->struct_size, value);
  return {};
}

Result<void> load(const char* path, flowdlo_frame_folder** out, bool with_mask) {
  if (const auto there = check_there(path, "flowdlo_frame_folder_load: path"); !there)
    return there.error();
  if (const auto there = check_there(out, "flowdlo_frame_folder_load: folder"); !there) {
    return there.error();
  }
  auto folder = with_mask ? load_frame_folder(path) : load_frame_folder_without_mask(path);
  if (!folder) return folder.error();
  *out = std::make_unique<flowdlo_frame_folder>(flowdlo_frame_folder{*std::move(folder)}).release();
  return {};
}

flowdlo_image packed(const void* data, std::int32_t pixel) { return {data, 0, 0, pixel, 0}; }

Result<void> point_at(const flowdlo_frame_folder* folder, flowdlo_frame* out) {
  if (const auto there = check_there(folder, "flowdlo_frame_folder_frame: folder"); !there) {
    return there.error();
  }
  if (const auto fits = check_size(out); !fits) return fits.error();
  const FrameFolder& content = folder->content;
  flowdlo_frame frame = default_frame();
  frame.depth = packed(content.depth_m.data(), FLOWDLO_PIXEL_F32);
  frame.mask = packed(content.mask.data(), FLOWDLO_PIXEL_U8);
  if (!content.color_bgr.empty()) {
    frame.color = packed(content.color_bgr.data(), FLOWDLO_PIXEL_BGR8);
  }
  if (!content.instances.empty()) {
    frame.instances = packed(content.instances.data(), FLOWDLO_PIXEL_U16);
  }
  frame.width = content.width;
  frame.height = content.height;
  frame.fx = content.intrinsics.fx;
  frame.fy = content.intrinsics.fy;
  frame.cx = content.intrinsics.cx;
  frame.cy = content.intrinsics.cy;
  write(out, out->struct_size, frame);
  return {};
}

/// The name of the value that `bit` stands for; every other number of bits is none.
template <class Value>
const char* name_of_bit(std::uint32_t bit, Value last) {
  for (int value = 0; value <= static_cast<int>(last); ++value) {
    if (bit == 1U << static_cast<unsigned>(value)) return name_of(static_cast<Value>(value));
  }
  return "unknown";
}

}  // namespace
}  // namespace flowdlo::c_api

namespace guard = flowdlo::guard;
namespace c_api = flowdlo::c_api;

const char* flowdlo_status_name(flowdlo_status status) {
  if (status == FLOWDLO_OK) return "ok";
  if (status < FLOWDLO_OK || status > FLOWDLO_OUT_OF_MEMORY) return "unknown";
  return flowdlo::name_of(static_cast<flowdlo::ErrorCode>(status - 1));
}

const char* flowdlo_source_name(int32_t source) {
  if (source < FLOWDLO_SOURCE_PREDICTION || source > FLOWDLO_SOURCE_PRIOR) return "unknown";
  return flowdlo::name_of(static_cast<flowdlo::Source>(source));
}

const char* flowdlo_origin_name(int32_t origin) {
  if (origin < FLOWDLO_ORIGIN_FIRST_PRIOR || origin > FLOWDLO_ORIGIN_DRAW) return "unknown";
  return flowdlo::name_of(static_cast<flowdlo::Origin>(origin));
}

const char* flowdlo_doubt_name(uint32_t doubt) {
  return c_api::name_of_bit(doubt, flowdlo::Doubt::kNoDepth);
}

const char* flowdlo_left_out_name(uint32_t part) {
  return c_api::name_of_bit(part, flowdlo::LeftOut::kReadings);
}

const char* flowdlo_last_error() { return c_api::last_error(); }

const char* flowdlo_version() { return FLOWDLO_VERSION; }

flowdlo_status flowdlo_config_init(flowdlo_config* config, size_t struct_size) {
  return c_api::initialise(config, struct_size, c_api::default_config());
}

flowdlo_status flowdlo_frame_init(flowdlo_frame* frame, size_t struct_size) {
  return c_api::initialise(frame, struct_size, c_api::default_frame());
}

flowdlo_status flowdlo_estimate_init(flowdlo_estimate* estimate, size_t struct_size) {
  return c_api::initialise(estimate, struct_size, flowdlo_estimate{});
}

flowdlo_status flowdlo_alternative_init(flowdlo_alternative* alternative, size_t struct_size) {
  return c_api::initialise(alternative, struct_size, flowdlo_alternative{});
}

flowdlo_status flowdlo_frame_folder_load(const char* path, flowdlo_frame_folder** folder) {
  return c_api::told(
      guard::guarded("flowdlo_frame_folder_load", [&] { return c_api::load(path, folder, true); }));
}

flowdlo_status flowdlo_frame_folder_load_without_mask(const char* path,
                                                      flowdlo_frame_folder** folder) {
  return c_api::told(guard::guarded("flowdlo_frame_folder_load_without_mask",
                                    [&] { return c_api::load(path, folder, false); }));
}

flowdlo_status flowdlo_frame_folder_frame(const flowdlo_frame_folder* folder,
                                          flowdlo_frame* frame) {
  return c_api::told(
      guard::guarded("flowdlo_frame_folder_frame", [&] { return c_api::point_at(folder, frame); }));
}

void flowdlo_frame_folder_destroy(flowdlo_frame_folder* folder) { delete folder; }

flowdlo_status flowdlo_estimator_create(const flowdlo_config* config,
                                        flowdlo_estimator** estimator) {
  return c_api::told(
      guard::guarded("flowdlo_estimator_create", [&] { return c_api::create(config, estimator); }));
}

void flowdlo_estimator_destroy(flowdlo_estimator* estimator) { delete estimator; }

flowdlo_status flowdlo_estimator_estimate(flowdlo_estimator* estimator, const flowdlo_frame* frame,
                                          flowdlo_estimate* estimate) {
  return c_api::told(guard::guarded("flowdlo_estimator_estimate",
                                    [&] { return c_api::estimate(estimator, frame, estimate); }));
}

flowdlo_status flowdlo_estimator_alternative(const flowdlo_estimator* estimator, int32_t index,
                                             flowdlo_alternative* alternative) {
  return c_api::told(guard::guarded("flowdlo_estimator_alternative", [&] {
    return c_api::alternative(estimator, index, alternative);
  }));
}

const char* flowdlo_estimator_device(const flowdlo_estimator* estimator) {
  return estimator == nullptr ? "" : estimator->tracker.estimator()->device().c_str();
}

const char* flowdlo_estimator_field_device(const flowdlo_estimator* estimator) {
  return estimator == nullptr ? "" : estimator->tracker.estimator()->field_device().c_str();
}
