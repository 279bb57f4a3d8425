// The C interface: the same bits as the C++ one, from C99; and a clear error whatever comes in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "c_api/c99_caller.h"
#include "c_api/c_values.hpp"
#include "c_api/last_error.hpp"
#include "c_api/sized.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"
#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"
#include "support/rose_frame.hpp"
#include "support/source_dir.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::c_frame;
using testing::empty_estimate;
using testing::Handle;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::RoseFrame;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::WaveFrame;

flowdlo_config config_with(const char* weights) {
  flowdlo_config config;
  if (flowdlo_config_init(&config, sizeof(config)) != FLOWDLO_OK) {
    throw std::runtime_error(flowdlo_last_error());
  }
  config.weights = weights;
  config.device = "cpu";
  config.euler_steps = 2;
  config.draws = 2;
  return config;
}

Handle make(const flowdlo_config& config) {
  flowdlo_estimator* estimator = nullptr;
  if (flowdlo_estimator_create(&config, &estimator) != FLOWDLO_OK) {
    throw std::runtime_error(flowdlo_last_error());
  }
  return Handle(estimator);
}

Handle make() { return make(config_with(FLOWDLO_WEIGHTS)); }

Estimate reference(const char* weights, const Frame& frame, int steps = 2, int draws = 2) {
  auto estimator = Estimator::create(
      {.weights = weights, .device = "cpu", .euler_steps = steps, .draws = draws});
  if (!estimator) throw std::runtime_error(estimator.error().message);
  auto estimate = estimator->estimate(frame);
  if (!estimate) throw std::runtime_error(estimate.error().message);
  return *std::move(estimate);
}

template <class Some, class Other>
bool same_bits(const Some& some, const Other& other) {
  static_assert(sizeof(Some) == sizeof(Other));
  return std::memcmp(&some, &other, sizeof(Some)) == 0;
}

void expect_same(const flowdlo_estimate& c, const Estimate& cpp) {
  EXPECT_TRUE(same_bits(c.nodes, cpp.nodes));
  EXPECT_TRUE(same_bits(c.sigma_m, cpp.sigma_m));
  EXPECT_TRUE(same_bits(c.support, cpp.support));
  EXPECT_EQ(c.confidence, cpp.confidence);
  EXPECT_EQ(c.mask_agreement, cpp.mask_agreement);
  EXPECT_EQ(c.prior_mask_agreement, cpp.prior_mask_agreement);
  EXPECT_EQ(c.source, static_cast<int>(cpp.source));
  EXPECT_EQ(c.draw, cpp.draw);
  EXPECT_EQ(c.calibrated, cpp.calibrated ? 1 : 0);
  EXPECT_EQ(c.readings, cpp.readings);
  EXPECT_EQ(c.alternatives, static_cast<int>(cpp.alternatives.size()));
  const OneRope& one = cpp.one_rope;
  EXPECT_EQ((std::array{c.explained, c.slender, c.sides, c.even, c.left_over, c.off_mask,
                        c.bare_gap, c.goes_on}),
            (std::array{one.explained, one.slender, one.sides, one.even, one.left_over,
                        one.off_mask, one.bare_gap, one.goes_on}));
  std::uint32_t doubts = 0;
  for (const Doubt doubt : one.doubts) doubts |= 1U << static_cast<unsigned>(doubt);
  EXPECT_EQ(c.doubts, doubts);
  int accepted = 0;
  for (const DrawReport& draw : cpp.draws) accepted += draw.accepted ? 1 : 0;
  EXPECT_EQ(c.accepted_draws, accepted);
}

TEST(CApi, C99GetsTheSameBitsAsCpp) {
  const auto folder = (test::source_dir() / "examples/frames/overhand_loop").string();
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded);
  const Estimate expected = reference(FLOWDLO_DEFAULT_WEIGHTS, loaded->frame(), 3, 2);

  flowdlo_estimate estimate;
  std::vector<flowdlo_alternative> alternatives(8);
  ASSERT_EQ(c99_estimate(folder.c_str(), FLOWDLO_DEFAULT_WEIGHTS, 3, 2, &estimate,
                         alternatives.data(), 8),
            FLOWDLO_OK)
      << flowdlo_last_error();
  expect_same(estimate, expected);
  EXPECT_GT(estimate.total_ms, 0);
}

TEST(CApi, ACamerasOwnImagesGiveTheBitsOfTheirMetres) {
  WaveFrame wave(640, 480, 14);
  wave.camera = {605.1F, 605.2F, 321.4F, 241.9F};
  constexpr std::size_t kPadded = 648;
  std::vector<std::uint16_t> units(kPadded * 480, 12345);
  for (std::size_t v = 0; v < 480; ++v) {
    for (std::size_t u = 0; u < 640; ++u) {
      float& depth_m = wave.depth_m[v * 640 + u];
      units[v * kPadded + u] = static_cast<std::uint16_t>(depth_m * 1000 + 0.5F);
      depth_m = static_cast<float>(units[v * kPadded + u] * 0.001);
    }
  }
  const Handle estimator = make(config_with(FLOWDLO_DEFAULT_WEIGHTS));
  flowdlo_estimate estimate = empty_estimate();
  ASSERT_EQ(
      c99_estimate_camera(estimator.get(), units.data(), kPadded * 2, wave.mask.data(), &estimate),
      FLOWDLO_OK)
      << flowdlo_last_error();
  expect_same(estimate, reference(FLOWDLO_DEFAULT_WEIGHTS, wave.frame()));
}

TEST(CApi, AlternativesAndDoubtsAreThoseOfCpp) {  // a rose leaves other ways
  const RoseFrame rose;
  const Estimate expected = reference(FLOWDLO_DEFAULT_WEIGHTS, rose.frame());
  const Handle estimator = make(config_with(FLOWDLO_DEFAULT_WEIGHTS));
  const flowdlo_frame frame = c_frame(rose.frame());
  flowdlo_estimate estimate = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimate), FLOWDLO_OK);
  expect_same(estimate, expected);

  ASSERT_THAT(expected.alternatives, ::testing::Not(IsEmpty()));
  for (int i = 0; i < estimate.alternatives; ++i) {
    flowdlo_alternative other;
    ASSERT_EQ(flowdlo_alternative_init(&other, sizeof(other)), FLOWDLO_OK);
    ASSERT_EQ(flowdlo_estimator_alternative(estimator.get(), i, &other), FLOWDLO_OK);
    const Alternative& one = expected.alternatives[static_cast<std::size_t>(i)];
    EXPECT_TRUE(same_bits(other.nodes, one.nodes));
    EXPECT_EQ(other.score, one.score);
    EXPECT_EQ(other.mask_agreement, one.mask_agreement);
  }
  flowdlo_alternative beyond;
  ASSERT_EQ(flowdlo_alternative_init(&beyond, sizeof(beyond)), FLOWDLO_OK);
  for (const int index : {-1, estimate.alternatives}) {
    EXPECT_EQ(flowdlo_estimator_alternative(estimator.get(), index, &beyond), FLOWDLO_BAD_INPUT);
    EXPECT_THAT(flowdlo_last_error(), HasSubstr("index: expected 0 or more and below"));
  }
}

TEST(CApi, AFailedEstimateLeavesNoAlternativesAndTheResultAlone) {
  const RoseFrame rose;
  const Handle estimator = make(config_with(FLOWDLO_DEFAULT_WEIGHTS));
  flowdlo_frame frame = c_frame(rose.frame());
  flowdlo_estimate estimate = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimate), FLOWDLO_OK);
  ASSERT_GT(estimate.alternatives, 0);

  const flowdlo_estimate before = estimate;
  const std::vector<std::uint8_t> nothing(rose.mask.size(), 0);
  frame.mask.data = nothing.data();
  EXPECT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimate), FLOWDLO_NO_EVIDENCE);
  EXPECT_TRUE(same_bits(before, estimate));
  flowdlo_alternative other;
  ASSERT_EQ(flowdlo_alternative_init(&other, sizeof(other)), FLOWDLO_OK);
  EXPECT_EQ(flowdlo_estimator_alternative(estimator.get(), 0, &other), FLOWDLO_BAD_INPUT);
}

TEST(CApi, DefaultsAreThoseOfCpp) {
  flowdlo_config config;
  ASSERT_EQ(flowdlo_config_init(&config, sizeof(config)), FLOWDLO_OK);
  const Config defaults;
  EXPECT_EQ(config.struct_size, sizeof(config));
  EXPECT_EQ(config.weights, nullptr);
  EXPECT_EQ(config.device, nullptr);
  EXPECT_EQ(config.euler_steps, defaults.euler_steps);
  EXPECT_EQ(config.draws, defaults.draws);
  EXPECT_EQ(config.max_width, defaults.max_width);
  EXPECT_EQ(config.max_height, defaults.max_height);
  EXPECT_EQ(config.quality, static_cast<int>(defaults.quality));
  EXPECT_EQ(config.probe, 1);
}

TEST(CApi, EveryFieldOfTheConfigReachesTheEstimator) {  // each fault is named once it got there
  flowdlo_config config = config_with(FLOWDLO_WEIGHTS);
  config.rope_length_m = -1;
  config.quality = config.prior = config.gate = config.field = 9;
  config.euler_steps = config.draws = config.threads = -1;
  config.max_width = config.max_height = config.device_timeout_ms = -1;
  config.device = "";
  flowdlo_estimator* estimator = nullptr;
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_BAD_INPUT);
  EXPECT_EQ(estimator, nullptr);
  for (const char* field :
       {"rope_length_m", "quality", "prior", "gate", "field", "euler_steps", "draws", "threads",
        "max_width", "max_height", "device_timeout_ms", "device"}) {
    EXPECT_THAT(flowdlo_last_error(), HasSubstr(std::string("Config.") + field + ": "));
  }
  config = config_with(FLOWDLO_WEIGHTS);
  config.reserved = 1;
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_config.reserved: expected 0, got 1"));
  config = config_with(FLOWDLO_WEIGHTS);
  config.reserved_2 = 2;
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_config.reserved_2: expected 0, got 2"));
  config = config_with(FLOWDLO_WEIGHTS);
  config.field_device = 9;
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("Config.field_device: "));
  config = config_with(FLOWDLO_WEIGHTS);
  config.ropes = 33;
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("Config.ropes: "));
  config = config_with("no/such/file.fdw");
  EXPECT_NE(flowdlo_estimator_create(&config, &estimator), FLOWDLO_OK);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("no/such/file.fdw"));
  config = config_with(FLOWDLO_DEFAULT_WEIGHTS);
  config.field_weights = "no/such/field.safetensors";
  EXPECT_NE(flowdlo_estimator_create(&config, &estimator), FLOWDLO_OK);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("no/such/field.safetensors"));
  config = config_with(FLOWDLO_WEIGHTS);
  config.device = "no such device";
  EXPECT_EQ(flowdlo_estimator_create(&config, &estimator), FLOWDLO_NO_DEVICE);
}

TEST(CApi, TheSeedReachesTheEstimator) {
  const WaveFrame wave;
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_config config = config_with(FLOWDLO_DEFAULT_WEIGHTS);
  config.gate = FLOWDLO_GATE_THESIS;
  std::array<flowdlo_estimate, 2> estimates = {empty_estimate(), empty_estimate()};
  for (std::size_t i = 0; i < 2; ++i) {
    config.seed = i * 1234567890123456789ULL;
    const Handle estimator = make(config);
    ASSERT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimates[i]), FLOWDLO_OK);
    Config cpp{.weights = FLOWDLO_DEFAULT_WEIGHTS,
               .device = "cpu",
               .euler_steps = 2,
               .draws = 2,
               .seed = config.seed,
               .gate = GateChoice::kThesis};
    auto same = Estimator::create(cpp);
    ASSERT_TRUE(same);
    expect_same(estimates[i], *same->estimate(wave.frame()));
  }
}

TEST(CApi, NullIsAnErrorNotACrash) {
  const Handle estimator = make();
  const WaveFrame wave;
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_estimate estimate = empty_estimate();
  const auto refused = [](flowdlo_status status) {
    EXPECT_EQ(status, FLOWDLO_BAD_INPUT);
    EXPECT_THAT(flowdlo_last_error(), HasSubstr("got NULL"));
  };
  refused(flowdlo_config_init(nullptr, sizeof(flowdlo_config)));
  refused(flowdlo_frame_init(nullptr, sizeof(flowdlo_frame)));
  refused(flowdlo_estimate_init(nullptr, sizeof(flowdlo_estimate)));
  refused(flowdlo_alternative_init(nullptr, sizeof(flowdlo_alternative)));
  refused(flowdlo_estimator_create(nullptr, nullptr));
  refused(flowdlo_estimator_estimate(nullptr, &frame, &estimate));
  refused(flowdlo_estimator_estimate(estimator.get(), nullptr, &estimate));
  refused(flowdlo_estimator_estimate(estimator.get(), &frame, nullptr));
  refused(flowdlo_estimator_alternative(nullptr, 0, nullptr));
  refused(flowdlo_estimator_alternative(estimator.get(), 0, nullptr));
  flowdlo_frame_folder* folder = nullptr;
  refused(flowdlo_frame_folder_load(nullptr, &folder));
  refused(flowdlo_frame_folder_load("somewhere", nullptr));
  refused(flowdlo_frame_folder_frame(nullptr, nullptr));
  flowdlo_frame no_images;
  ASSERT_EQ(flowdlo_frame_init(&no_images, sizeof(no_images)), FLOWDLO_OK);
  no_images.width = no_images.height = 10;
  refused(flowdlo_estimator_estimate(estimator.get(), &no_images, &estimate));
  EXPECT_STREQ(flowdlo_estimator_device(nullptr), "");
  EXPECT_STREQ(flowdlo_estimator_device(estimator.get()), "cpu");
  EXPECT_STREQ(flowdlo_estimator_field_device(nullptr), "");
  EXPECT_STREQ(flowdlo_estimator_field_device(estimator.get()), "");  // its weights have no field
  flowdlo_estimator_destroy(nullptr);
  flowdlo_frame_folder_destroy(nullptr);
}

TEST(CApi, AStructOfAnotherSizeIsAnError) {
  const Handle estimator = make();
  const WaveFrame wave;
  for (const std::size_t size : {std::size_t{0}, sizeof(std::size_t), sizeof(flowdlo_frame) - 1,
                                 sizeof(flowdlo_frame) + 1, std::size_t{0} - 1}) {
    flowdlo_frame frame = c_frame(wave.frame());
    frame.struct_size = size;
    flowdlo_estimate estimate = empty_estimate();
    EXPECT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimate), FLOWDLO_BAD_INPUT);
    EXPECT_THAT(flowdlo_last_error(), StartsWith("flowdlo_frame.struct_size: expected "));
    EXPECT_THAT(flowdlo_last_error(), HasSubstr("got " + std::to_string(size)));
    EXPECT_EQ(flowdlo_frame_init(&frame, size), FLOWDLO_BAD_INPUT);
    EXPECT_EQ(flowdlo_frame_folder_frame(nullptr, &frame), FLOWDLO_BAD_INPUT);
  }
  flowdlo_config config = config_with(FLOWDLO_WEIGHTS);
  config.struct_size = 0;
  flowdlo_estimator* none = nullptr;
  EXPECT_EQ(flowdlo_estimator_create(&config, &none), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_config_init"));
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_estimate estimate = empty_estimate();
  estimate.struct_size = 8;
  EXPECT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &estimate), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_estimate_init"));
}

/// A struct of a later version: what an older program passes lacks its last field.
struct Grown {
  std::size_t struct_size;
  std::int64_t old;
  std::int64_t added;
};

TEST(Sized, AnOlderStructIsReadWithDefaultsAndWrittenWithinItsSize) {
  const Grown defaults{sizeof(Grown), 1, 2};
  Grown given{offsetof(Grown, added), 7, 77};
  EXPECT_EQ(c_api::read(&given, defaults).old, 7);
  EXPECT_EQ(c_api::read(&given, defaults).added, 2);
  c_api::write(&given, given.struct_size, Grown{0, 8, 88});
  EXPECT_EQ(given.struct_size, offsetof(Grown, added));
  EXPECT_EQ(given.old, 8);
  EXPECT_EQ(given.added, 77);
}

TEST(CApi, StructsAreOfOneSizeInCAndCpp) {
  std::array<std::size_t, 4> sizes{};
  c99_sizes(sizes.data());
  EXPECT_EQ(sizes, (std::array{sizeof(flowdlo_config), sizeof(flowdlo_frame),
                               sizeof(flowdlo_estimate), sizeof(flowdlo_alternative)}));
}

TEST(CApi, AFolderThatIsNotThereIsNamed) {
  flowdlo_frame_folder* folder = nullptr;
  EXPECT_EQ(flowdlo_frame_folder_load("no/such/folder", &folder), FLOWDLO_IO);
  EXPECT_EQ(folder, nullptr);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("no/such/folder"));
}

TEST(CApi, EachThreadHasItsOwnLastError) {
  ASSERT_EQ(flowdlo_config_init(nullptr, 0), FLOWDLO_BAD_INPUT);
  const std::string here = flowdlo_last_error();
  std::string there = "nothing was asked";
  std::thread([&] { there = flowdlo_last_error(); }).join();
  EXPECT_THAT(here, HasSubstr("flowdlo_config"));
  EXPECT_EQ(there, "");
}

TEST(LastError, IsCutBetweenCharacters) {
  std::string message(4094, 'a');
  for (int i = 0; i < 100; ++i) message += "\xC3\xA9";  // two bytes a character
  EXPECT_EQ(c_api::told(Error{ErrorCode::kIo, message}), FLOWDLO_IO);
  EXPECT_THAT(std::string(c_api::last_error()), SizeIs(4094));
  message.insert(0, 1, 'b');
  EXPECT_EQ(c_api::told(Error{ErrorCode::kIo, message}), FLOWDLO_IO);
  EXPECT_THAT(std::string(c_api::last_error()), SizeIs(4095));
}

TEST(CApi, StatusesHaveTheNamesOfTheErrorCodes) {
  EXPECT_STREQ(flowdlo_status_name(FLOWDLO_OK), "ok");
  EXPECT_STREQ(flowdlo_status_name(FLOWDLO_BAD_INPUT), "bad_input");
  EXPECT_STREQ(flowdlo_status_name(FLOWDLO_OUT_OF_MEMORY), "out_of_memory");
  EXPECT_STREQ(flowdlo_status_name(-1), "unknown");
  EXPECT_STREQ(flowdlo_status_name(FLOWDLO_OUT_OF_MEMORY + 1), "unknown");
}

TEST(CApi, SourcesOriginsDoubtsAndPartsLeftOutHaveOneNameInEveryLanguage) {
  EXPECT_STREQ(flowdlo_source_name(FLOWDLO_SOURCE_PREDICTION), "prediction");
  EXPECT_STREQ(flowdlo_source_name(FLOWDLO_SOURCE_PRIOR), "prior");
  EXPECT_STREQ(flowdlo_origin_name(FLOWDLO_ORIGIN_FIRST_PRIOR), "first_prior");
  EXPECT_STREQ(flowdlo_origin_name(FLOWDLO_ORIGIN_RUNNER_UP), "runner_up");
  EXPECT_STREQ(flowdlo_origin_name(FLOWDLO_ORIGIN_OTHER_READING), "other_reading");
  EXPECT_STREQ(flowdlo_origin_name(FLOWDLO_ORIGIN_FRAME_BEFORE), "frame_before");
  EXPECT_STREQ(flowdlo_origin_name(FLOWDLO_ORIGIN_DRAW), "draw");
  EXPECT_STREQ(flowdlo_doubt_name(FLOWDLO_DOUBT_NO_ROPE), "no_rope");
  EXPECT_STREQ(flowdlo_doubt_name(FLOWDLO_DOUBT_STRANDS_LEFT), "strands_left");
  EXPECT_STREQ(flowdlo_doubt_name(FLOWDLO_DOUBT_BARE_GAP), "bare_gap");
  EXPECT_STREQ(flowdlo_doubt_name(FLOWDLO_DOUBT_GOES_ON), "goes_on");
  EXPECT_STREQ(flowdlo_doubt_name(FLOWDLO_DOUBT_NO_DEPTH), "no_depth");
  EXPECT_STREQ(flowdlo_left_out_name(FLOWDLO_LEFT_OUT_MODEL), "model");
  EXPECT_STREQ(flowdlo_left_out_name(FLOWDLO_LEFT_OUT_FIELD), "strand_field");
  EXPECT_STREQ(flowdlo_left_out_name(FLOWDLO_LEFT_OUT_READINGS), "readings");
}

TEST(CApi, WhatIsNoValueIsCalledUnknown) {
  for (const int value : {-1, FLOWDLO_SOURCE_PRIOR + 1, INT32_MAX, INT32_MIN}) {
    EXPECT_STREQ(flowdlo_source_name(value), "unknown") << value;
  }
  for (const int value : {-1, FLOWDLO_ORIGIN_DRAW + 1, INT32_MAX, INT32_MIN}) {
    EXPECT_STREQ(flowdlo_origin_name(value), "unknown") << value;
  }
  for (const std::uint32_t bits : {0U, 3U, 2U * FLOWDLO_DOUBT_NO_DEPTH, UINT32_MAX}) {
    EXPECT_STREQ(flowdlo_doubt_name(bits), "unknown") << bits;
  }
  for (const std::uint32_t bits : {0U, 6U, 2U * FLOWDLO_LEFT_OUT_READINGS, UINT32_MAX}) {
    EXPECT_STREQ(flowdlo_left_out_name(bits), "unknown") << bits;
  }
}

TEST(CApi, VersionIsTheHeaders) { EXPECT_STREQ(flowdlo_version(), FLOWDLO_VERSION); }

}  // namespace
}  // namespace flowdlo
