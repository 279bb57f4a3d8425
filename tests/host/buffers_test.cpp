// Frames that lie in buffers of the host's device: the bits of the same frame in memory, after what
// they wait for and before what they signal.
#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

#include "host/host_fixture.hpp"

namespace flowdlo::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Depth and mask in one buffer, at odd places.
class FrameBuffer {
 public:
  FrameBuffer(const Host& host, const WaveFrame& wave)
      : wave_(wave),
        depth_bytes_(wave.depth_m.size() * sizeof(float)),
        buffer_(host, kDepthAt + depth_bytes_ + kGap + wave.mask.size()) {}

  void fill() {
    std::memcpy(buffer_.bytes() + kDepthAt, wave_.depth_m.data(), depth_bytes_);
    std::memcpy(buffer_.bytes() + mask_at(), wave_.mask.data(), wave_.mask.size());
  }
  void spoil() { std::memset(buffer_.bytes(), 0x7F, bytes()); }
  [[nodiscard]] VulkanFrame frame() const {
    VulkanFrame frame;
    frame.width = wave_.width;
    frame.height = wave_.height;
    frame.intrinsics = wave_.camera;
    frame.depth_m = {buffer_.handle(), kDepthAt};
    frame.mask = {buffer_.handle(), mask_at()};
    return frame;
  }
  [[nodiscard]] VkBuffer handle() const { return buffer_.handle(); }
  [[nodiscard]] VkDeviceSize bytes() const { return mask_at() + wave_.mask.size(); }

 private:
  static constexpr VkDeviceSize kDepthAt = 12;
  static constexpr VkDeviceSize kGap = 5;
  [[nodiscard]] VkDeviceSize mask_at() const { return kDepthAt + depth_bytes_ + kGap; }

  const WaveFrame& wave_;
  VkDeviceSize depth_bytes_;
  HostBuffer buffer_;
};

EstimateBits bits_without_tensors(const Result<Estimate>& estimate) {
  EXPECT_TRUE(estimate) << estimate.error().message;
  return estimate ? bits_of(*estimate) : EstimateBits();
}

TEST_F(HostTest, GivesTheSameBitsOfABufferAsOfMemory) {
  Host& program = host();
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  const auto expected = bits_without_tensors(made->estimate(wave_.frame()));
  FrameBuffer buffer(program, wave_);
  buffer.fill();
  EXPECT_TRUE(bits_without_tensors(made->estimate(buffer.frame())) == expected);

  // Larger, smaller, and as a view for every other estimate.
  const WaveFrame larger(240, 180, 8.0F);
  FrameBuffer second(program, larger);
  second.fill();
  EXPECT_TRUE(bits_without_tensors(made->estimate(second.frame())) ==
              bits_without_tensors(made->estimate(larger.frame())));
  const auto fetched = made->fetch(buffer.frame());
  ASSERT_TRUE(fetched);
  EXPECT_TRUE(bits_of(*made, *fetched) == bits_of(*made, wave_.frame()));
  const auto ropes = made->estimate_ropes(*fetched);
  EXPECT_TRUE(ropes);
}

TEST_F(HostTest, SeesWhatTheQueueWasGivenBeforeWithoutAnySemaphore) {
  Host& program = host();
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  const auto expected = bits_without_tensors(made->estimate(wave_.frame()));
  FrameBuffer camera(program, wave_);
  camera.fill();
  FrameBuffer buffer(program, wave_);
  VkCommandBuffer commands = program.begin();
  const VkBufferCopy all{0, 0, camera.bytes()};
  vkCmdCopyBuffer(commands, camera.handle(), buffer.handle(), 1, &all);
  ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  VkSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  ASSERT_EQ(program.submit_and_wait(info), VK_SUCCESS);
  EXPECT_TRUE(bits_without_tensors(made->estimate(buffer.frame())) == expected);
}

/// The host's own work fills the buffer once it is free, and says so; all on one queue.
void submit_copy(Host& program, const FrameBuffer& from, const FrameBuffer& to, VkDeviceSize bytes,
                 const VulkanMoment& wait, const VulkanMoment& signal) {
  VkCommandBuffer commands = program.begin();
  const VkBufferCopy all{0, 0, bytes};
  vkCmdCopyBuffer(commands, from.handle(), to.handle(), 1, &all);
  ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
  VkTimelineSemaphoreSubmitInfo values{};
  values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
  values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
  values.pWaitSemaphoreValues = &wait.value;
  values.pSignalSemaphoreValues = &signal.value;
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
  VkSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.pNext = &values;
  info.waitSemaphoreCount = info.signalSemaphoreCount = 1;
  info.pWaitSemaphores = &wait.semaphore;
  info.pSignalSemaphores = &signal.semaphore;
  info.pWaitDstStageMask = &stage;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  ASSERT_EQ(program.submit(info), VK_SUCCESS);
}

TEST_F(HostTest, TakesTurnsWithTheEstimatorByTimelineSemaphores) {
  Host& program = host();
  ASSERT_TRUE(program.needs().wanted.timeline_semaphore);
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  const auto expected = bits_without_tensors(made->estimate(wave_.frame()));
  FrameBuffer camera(program, wave_);
  camera.fill();
  FrameBuffer buffer(program, wave_);
  const Timeline filled(program);
  const Timeline free(program);
  VulkanFrame frame = buffer.frame();
  for (std::uint64_t round = 1; round <= 3; ++round) {
    submit_copy(program, camera, buffer, camera.bytes(), free.at(round - 1), filled.at(round));
    const std::vector<VulkanMoment> waits = {filled.at(round)};
    const std::vector<VulkanMoment> signals = {free.at(round)};
    frame.waits = waits;
    frame.signals = signals;
    EXPECT_TRUE(bits_without_tensors(made->estimate(frame)) == expected);
    EXPECT_EQ(free.value(), round);
  }
}

/// Without the layers: those of 1.3.239 wait 10 s for a semaphore that the processor has signalled
/// meanwhile, and call that "most likely a validation bug".
TEST_F(HostTest, SignalsAFrameThatComesLateFromItsProcessor) {
  Host& program = host({.layers = false});
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  const auto expected = bits_without_tensors(made->estimate(wave_.frame()));
  FrameBuffer buffer(program, wave_);
  const Timeline camera(program);
  const Timeline other(program);
  const Timeline free(program);
  for (std::uint64_t round = 1; round <= 3; ++round) {
    buffer.spoil();
    VulkanFrame frame = buffer.frame();
    const std::vector<VulkanMoment> waits = {camera.at(round), other.at(10 * round)};
    const std::vector<VulkanMoment> signals = {free.at(round)};
    frame.waits = waits;
    frame.signals = signals;
    std::thread producer([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      EXPECT_EQ(free.value(), round - 1) << "the frame was not there yet";
      buffer.fill();
      camera.signal(round);
      other.signal(10 * round);
    });
    const auto estimate = made->estimate(frame);
    producer.join();
    EXPECT_TRUE(bits_without_tensors(estimate) == expected);
    EXPECT_EQ(free.value(), round);
  }
}

TEST_F(HostTest, IsNotLeftWaitingByAFrameThatIsRefused) {
  Host& program = host();
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  FrameBuffer buffer(program, wave_);
  const Timeline timeline(program);
  const std::vector<VulkanMoment> signals = {timeline.at(1)};
  VulkanFrame frame = buffer.frame();
  frame.signals = signals;
  frame.depth_m = {};
  frame.mask.offset += 1;  // one byte beyond the buffer, or more than it has
  frame.mask.offset += VkDeviceSize{1} << 30U;
  const auto refused = made->estimate(frame);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("VulkanFrame.depth_m.buffer: expected a VkBuffer, got null"),
                    HasSubstr("VulkanFrame.mask: expected a buffer of ")));
  EXPECT_TRUE(timeline.comes_to(1));

  frame = buffer.frame();
  frame.width = 5000;
  const auto wide = made->estimate(frame);
  ASSERT_FALSE(wide);
  EXPECT_THAT(wide.error().message, HasSubstr("width, height: expected 1..4096, got 5000 x 120"));
  frame = buffer.frame();
  const std::vector<VulkanMoment> nobody(1);
  frame.waits = nobody;
  const auto waiting = made->estimate(frame);
  ASSERT_FALSE(waiting);
  EXPECT_THAT(waiting.error().message, HasSubstr("VulkanFrame.waits[0].semaphore: expected"));
  frame = buffer.frame();
  EXPECT_FALSE(made->estimate(frame)) << "of an empty mask";
}

TEST_F(HostTest, HearsThatTimelineSemaphoresAreMissing) {
  Host& program = host({.features = false});
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  FrameBuffer buffer(program, wave_);
  buffer.fill();
  EXPECT_TRUE(made->estimate(buffer.frame())) << "without semaphores none are needed";
  VulkanFrame frame = buffer.frame();
  // Never looked at: a device without the feature has no such semaphore.
  const std::vector<VulkanMoment> waits = {{reinterpret_cast<VkSemaphore>(&program), 1}};
  frame.waits = waits;
  const auto refused = made->estimate(frame);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(refused.error().message, HasSubstr("VulkanHost.enabled.timeline_semaphore"));
}

TEST_F(HostTest, IsNotHeldForEverByAFrameThatNeverComes) {
  Host& program = host({.layers = false});  // see above
  Config config = host_config();
  config.device_timeout_ms = 5000;
  auto made = Estimator::create(config, program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  FrameBuffer buffer(program, wave_);
  buffer.fill();
  const Timeline camera(program);
  const std::vector<VulkanMoment> waits = {camera.at(1)};
  VulkanFrame frame = buffer.frame();
  frame.waits = waits;
  const auto late = made->fetch(frame);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kDeviceLost);
  const auto next = made->fetch(buffer.frame());
  ASSERT_FALSE(next);
  EXPECT_THAT(next.error().message, HasSubstr("expected the frame before to be copied"));
  camera.signal(1);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  auto fetched = made->fetch(buffer.frame());
  while (!fetched && std::chrono::steady_clock::now() < until)
    fetched = made->fetch(buffer.frame());
  ASSERT_TRUE(fetched) << fetched.error().message;
  EXPECT_EQ(std::memcmp(fetched->mask.data(), wave_.mask.data(), wave_.mask.size()), 0);
}

TEST_F(HostTest, GetsNoFrameFromItsBuffersByAnEstimatorOnAnotherDevice) {
  Host& program = host();
  FrameBuffer buffer(program, wave_);
  Config config = host_config();
  config.device = "cpu";
  auto made = Estimator::create(config);
  ASSERT_TRUE(made);
  const auto refused = made->estimate(buffer.frame());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(refused.error().message, HasSubstr("make it with a VulkanHost"));
  // In braces it is a Frame, here too, where both are known.
  const auto nothing = made->estimate(
      {.width = 0, .height = 1, .intrinsics = {}, .depth_m = {}, .mask = {}, .color_bgr = {}});
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("Frame."));
}

}  // namespace
}  // namespace flowdlo::testing
