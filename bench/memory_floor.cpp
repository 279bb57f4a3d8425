// What a Vulkan driver holds in a process before there is anything of ours in it: resident memory
// at the start, with an instance and a device, and after one dispatch of the smallest kernel.
//
//   memory_floor [--device=NAME]
#include <array>
#include <cstdio>
#include <string>

#include "device_option.hpp"
#include "ops/program.hpp"
#include "resident_memory.hpp"
#include "vulkan/backend.hpp"

namespace flowdlo {
namespace {

void print(const char* what, double since_mb) {
  const double now_mb = support::resident_mb();
  std::printf("%-24s %7.1f MB, %6.1f MB more than at the start\n", what, now_mb, now_mb - since_mb);
}

Result<void> dispatch(const std::shared_ptr<vulkan::Device>& device) {
  const auto program = vulkan::create_program(device);
  const auto out = program->output("out", 1, 4);
  const auto norm = program->constant("norm", 1, 4, std::array{0.0F, 0.0F, 0.0F, 1.0F});
  const auto in = program->constant("in", 1, 4, std::array{1.0F, 2.0F, 3.0F, 4.0F});
  program->record(ops::Denormalize{.state = in, .norm = norm, .out = out});
  if (auto built = program->build(); !built) return built;
  return program->run();
}

int measure(const std::string& wanted) {
  const double start_mb = support::resident_mb();
  print("start", start_mb);
  const auto device = vulkan::open_device({.wanted = wanted});
  if (!device) {
    std::printf("skipped: %s\n", device.error().message.c_str());
    return 0;
  }
  print("instance and device", start_mb);
  const auto ran = dispatch(*device);
  if (!ran) {
    std::fprintf(stderr, "%s\n", ran.error().message.c_str());
    return 1;
  }
  print("one dispatch", start_mb);
  std::printf("%s\n", vulkan::report(**device).name.c_str());
  return 0;
}

}  // namespace
}  // namespace flowdlo

int main(int argc, char** argv) {
  return flowdlo::measure(flowdlo::bench::wanted_device(argc, argv));
}
