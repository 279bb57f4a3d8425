// The CPU back end allocates when a program is made and built, and never again.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "reference/block_program.hpp"
#include "reference/program.hpp"

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment)) {
    return memory;
  }
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace flowdlo {
namespace {

TEST(Allocation, NoneInARunOfTheTransformerBlock) {
  for (const int draws : {1, 4}) {
    testing::BlockProgram block(reference::create_program(2), draws);
    const long before = allocations;
    ASSERT_GT(before, 0) << "the count does not work";
    for (int frame = 0; frame < 3; ++frame) ASSERT_TRUE(block.program->run());
    EXPECT_EQ(allocations, before) << draws << " draws";
  }
}

TEST(Allocation, NoneInFarthestPointSampling) {
  constexpr int kPoints = 5000;
  const auto program = reference::create_program(2);
  const auto cloud = program->input("cloud", kPoints, 4);
  const auto params = program->input("params", 1, sizeof(ops::FrameParams) / sizeof(float));
  const auto visible = program->output("visible", ops::kVisibleRows, 4);
  program->record(ops::FarthestPoints{.cloud = cloud, .params = params, .visible = visible});
  ASSERT_TRUE(program->build());
  ops::FrameParams values{};
  values.point_count = kPoints;
  std::vector<float> words(sizeof(values) / sizeof(float));
  std::memcpy(words.data(), &values, sizeof(values));
  program->write(params, words);
  program->write(cloud, testing::noise(std::size_t{kPoints} * 4, 1));
  const long before = allocations;
  for (int frame = 0; frame < 3; ++frame) ASSERT_TRUE(program->run());
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace flowdlo
