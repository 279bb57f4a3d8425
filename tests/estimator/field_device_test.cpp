// Where the strand field's network runs, and what it sees there.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "estimator/field_trial.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "reference/program.hpp"
#include "scene/scene.hpp"
#include "support/faulty_program.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo {
namespace {

using testing::FaultyProgram;

Config on(const char* device, FieldDevice field_device) {
  Config config{.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = device};
  config.field_device = field_device;
  config.threads = 2;
  config.validation = true;
  return config;
}

TEST(FieldDevice, IsTheCpuWithTheNativeBackEndWhateverIsAsked) {
  for (const auto choice : {FieldDevice::kFaster, FieldDevice::kCpu, FieldDevice::kSame}) {
    const auto made = Estimator::create(on("cpu", choice));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->field_device(), "cpu");
  }
}

TEST(FieldDevice, IsNoneWithoutAField) {
  Config config = on("cpu", FieldDevice::kSame);
  config.field = FieldChoice::kOff;
  auto made = Estimator::create(config);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->field_device(), "");
  const Estimator elsewhere = *std::move(made);
  EXPECT_EQ(made->field_device(), "");  // NOLINT(bugprone-use-after-move): what it promises
}

/// On this machine's Vulkan device, a CPU driver as a rule, with the layers watching.
TEST(FieldDevice, TheSameRopeIsFoundThroughTheDevicesField) {
  auto cpu = Estimator::create(on("cpu", FieldDevice::kCpu));
  ASSERT_TRUE(cpu);
  auto there = Estimator::create(on("vulkan", FieldDevice::kSame));
  if (!there && there.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << there.error().message;
  ASSERT_TRUE(there) << there.error().message;
  EXPECT_NE(there->device(), "cpu");
  EXPECT_EQ(there->field_device(), there->device());
  for (const auto& [kind, seed] :
       {std::pair{lab::Kind::kTouching, 1000U}, std::pair{lab::Kind::kCoil, 1000U},
        std::pair{lab::Kind::kManyCrossings, 1000U}}) {
    const lab::Scene scene = lab::make_scene(kind, seed);
    const auto a = cpu->estimate(scene.frame());
    const auto b = there->estimate(scene.frame());
    ASSERT_TRUE(a && b);
    EXPECT_LT(geometry::mean_distance(a->nodes, b->nodes), 1e-4F);
    EXPECT_NEAR(a->confidence, b->confidence, 0.01F);
    EXPECT_EQ(a->readings, b->readings);
  }
}

TEST(FieldDevice, ACpuDriverDoesNotGetItByItself) {
  const auto made = Estimator::create(on("vulkan", FieldDevice::kFaster));
  if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
  ASSERT_TRUE(made) << made.error().message;
  if (made->device().find("llvmpipe") == std::string::npos) GTEST_SKIP() << made->device();
  EXPECT_EQ(made->field_device(), "cpu");
}

/// The model is made by the first frame that asks for it, on the device that is in use.
TEST(FieldDevice, AModelThatWasLeftForLaterGivesTheSameTensors) {
  const lab::Scene scene = lab::make_scene(lab::Kind::kTouching, 1000);
  Config config = on("cpu", FieldDevice::kCpu);
  auto later = Estimator::create(config);
  ASSERT_TRUE(later) << later.error().message;
  config.euler_steps = later->euler_steps();
  config.draws = later->draws();
  config.quality = Quality::kFull;
  auto at_once = Estimator::create(config);
  ASSERT_TRUE(at_once) << at_once.error().message;
  ASSERT_TRUE(later->estimate(scene.frame()));
  Tensors a;
  Tensors b;
  ASSERT_TRUE(later->estimate(scene.frame(), a));
  ASSERT_TRUE(at_once->estimate(scene.frame(), b));
  ASSERT_FALSE(a.prediction.empty());
  EXPECT_EQ(a.prediction, b.prediction);
}

std::shared_ptr<const weights::FieldWeights> noise() {
  return std::make_shared<const weights::FieldWeights>(weights::seeded_field({16, 16, 16}, 5));
}

field::Network network(FaultyProgram::Fault fault) {
  auto made =
      field::Network::create(noise(), [fault] { return std::make_unique<FaultyProgram>(fault); });
  if (!made) throw std::runtime_error(made.error().message);
  return *std::move(made);
}

TEST(FieldTrial, NoticesOneValueThatIsOff) {
  auto right = network(FaultyProgram::Fault::kNone);
  auto wrong = network(FaultyProgram::Fault::kWrongField);
  const auto same = estimator::try_field(right, right);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->difference, 0);
  EXPECT_TRUE(same->agrees());
  const auto other = estimator::try_field(wrong, right);
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->agrees());
}

TEST(FieldTrial, FailsWithTheDevice) {
  auto right = network(FaultyProgram::Fault::kNone);
  auto lost = network(FaultyProgram::Fault::kLost);
  const auto trial = estimator::try_field(lost, right);
  ASSERT_FALSE(trial);
  EXPECT_EQ(trial.error().code, ErrorCode::kDeviceLost);
}

}  // namespace
}  // namespace flowdlo
