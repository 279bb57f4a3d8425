// One program on a Vulkan device, under the validation layers where they are installed.
#include <gmock/gmock.h>

#include "faults/relayed.hpp"
#include "faults/walk.hpp"
#include "support/program_cases.hpp"
#include "vulkan/backend.hpp"

namespace flowdlo::testing {
namespace {

constexpr int kRows = 64;
constexpr int kColumns = 256;

/// What the layers say, but that of 1.3.239 they take what a lost device does, or what failed to be
/// submitted, for still under way.
std::vector<std::string> complaints(const vulkan::Device& device) {
  auto messages = vulkan::validation_messages(device);
  if (!relay()->lost()) return messages;
  std::erase_if(messages, [](const std::string& message) {
    return message.find("VUID-vkDestroyFence-fence-01120") != std::string::npos ||
           message.find("VUID-vkDestroyCommandPool-commandPool-00041") != std::string::npos;
  });
  return messages;
}

/// A device is opened, a program built and run twice; and the layers have nothing to say.
Result<std::string> build_and_run(const vulkan::ProgramOptions& options, bool layers) {
  const auto device =
      vulkan::open_device({.wanted = "vulkan", .validation = layers, .probing = {.on = false}});
  if (!device) return device.error();
  auto outcome = [&]() -> Result<std::string> {
    const auto program = vulkan::create_program(*device, options);
    const auto x = program->input("x", kRows, kColumns);
    const auto y = program->output("y", kRows, kColumns);
    const std::size_t size = kColumns * kColumns;
    const auto layer =
        program->layer("layer", kColumns, kColumns, noise(size, 1, 0.06F), noise(kColumns, 2));
    program->record(ops::Linear{.x = x, .layer = layer, .y = y, .residual = {}});
    if (const auto built = program->build(); !built) return built.error();
    std::vector<float> values(static_cast<std::size_t>(kRows) * kColumns);
    std::string bits;
    for (const std::uint64_t seed : {3U, 4U}) {
      program->write(x, noise(values.size(), seed));
      if (const auto done = program->run(); !done) return done.error();
      (void)program->stage_times_ms();
      program->read(y, values);
      bits.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    }
    return bits;
  }();
  EXPECT_THAT(complaints(**device), ::testing::IsEmpty());
  return outcome;
}

class ProgramWalk : public Relayed {};

constexpr vulkan::GemmChoice kChosen{vulkan::GemmFamily::kTile, 32, 32, 16};

TEST_F(ProgramWalk, OnACpuDriverEndsInAnErrorOrTheRightBits) {
  const vulkan::ProgramOptions options{.pipeline_cache = scratch_.path() / "pipelines",
                                       .gemm = kChosen};
  walk([&](bool layers) { return build_and_run(options, layers); }, Thoroughly::kSamples);
}

TEST_F(ProgramWalk, OnAGpuWithMemoryOfItsOwnEndsInAnErrorOrTheRightBits) {
  relay()->pose_as_gpu(true);  // weights go by a staging buffer
  walk([&](bool layers) { return build_and_run({.pipeline_cache = {}, .gemm = kChosen}, layers); },
       Thoroughly::kFirstAlone);
}

TEST_F(ProgramWalk, WhereAGpuTriesItsKernelsEndsInAnErrorOrTheRightBits) {
  relay()->pose_as_gpu(true);
  walk([&](bool layers) { return build_and_run({}, layers); }, Thoroughly::kFirstAlone, false,
       {"vkAllocateMemory", "vkCreateComputePipelines", "vkQueueSubmit", "vkWaitForFences"});
}

}  // namespace
}  // namespace flowdlo::testing
