// A program that has a Vulkan device lets the estimator run on it: beside its own work, with the
// bits of an estimator on its own device, and with errors that name what is lacking.
#include <atomic>
#include <cstdlib>
#include <map>
#include <optional>
#include <thread>

#include "host/host_fixture.hpp"
#include "host/triangles.hpp"

namespace flowdlo::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(HostTest, EstimatesWithTheBitsOfADeviceOfOurOwn) {
  auto own = Estimator::create(host_config());
  ASSERT_TRUE(own) << own.error().message;
  const auto expected = bits_of(*own, wave_.frame());
  for (const bool features : {true, false}) {
    SCOPED_TRACE(features ? "with all features wanted" : "with what is required alone");
    Host& program = host({.features = features});
    auto made = Estimator::create(host_config(), program.handed_over());
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->device(), own->device());
    EXPECT_TRUE(bits_of(*made, wave_.frame()) == expected);
    EXPECT_GT(program.times_locked(), 1);
    made = Error{};  // before its device
    end_host();
  }
}

TEST_F(HostTest, IsTestedBeforeAutoTakesIt) {
  Host& program = host();
  Config config = host_config();
  config.device = "auto";
  auto own = Estimator::create(host_config());
  ASSERT_TRUE(own);
  auto made = Estimator::create(config, program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->device(), own->device()) << "of a host's device a CPU driver will do";
  EXPECT_TRUE(bits_of(*made, wave_.frame()) == bits_of(*own, wave_.frame()));
}

TEST_F(HostTest, RendersAndEstimatesOnOneQueueInTurns) {
  Host& program = host();
  auto triangles = Triangles::make(program);
  ASSERT_NE(triangles, nullptr);
  auto made = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(made) << made.error().message;
  const auto expected = bits_of(*made, wave_.frame());
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(triangles->render(20));
    EXPECT_TRUE(bits_of(*made, wave_.frame()) == expected);
  }
}

TEST_F(HostTest, RendersAndEstimatesOnOneQueueFromTwoThreads) {
  Host& program = host();
  auto triangles = Triangles::make(program);
  ASSERT_NE(triangles, nullptr);
  std::atomic<bool> ends = false;
  std::atomic<int> rendered = 0;
  std::atomic<int> wrong = 0;
  std::thread renderer([&] {
    while (!ends) {
      if (!triangles->render(20)) ++wrong;
      ++rendered;
    }
  });
  {
    auto made = Estimator::create(host_config(), program.handed_over());
    EXPECT_TRUE(made);
    const auto expected = bits_of(*made, wave_.frame());
    const int before = rendered;
    for (int round = 0; round < 5 || rendered < before + 5; ++round) {
      EXPECT_TRUE(bits_of(*made, wave_.frame()) == expected);
    }
  }
  ends = true;
  renderer.join();
  EXPECT_EQ(wrong, 0) << "of " << rendered << " pictures";
}

TEST_F(HostTest, LetsSeveralEstimatorsShareItsDevice) {
  Host& program = host();
  auto first = Estimator::create(host_config(), program.handed_over());
  auto second = Estimator::create(host_config(), program.handed_over());
  ASSERT_TRUE(first && second);
  const auto expected = bits_of(*first, wave_.frame());
  int differing = 0;
  std::thread other([&] {
    for (int round = 0; round < 3; ++round) {
      if (bits_of(*second, wave_.frame()) != expected) ++differing;
    }
  });
  for (int round = 0; round < 3; ++round) EXPECT_TRUE(bits_of(*first, wave_.frame()) == expected);
  other.join();
  EXPECT_EQ(differing, 0);
  first = *std::move(second);  // the first one's goes, the second one's stays
  EXPECT_TRUE(bits_of(*first, wave_.frame()) == expected);
}

TEST_F(HostTest, KeepsNothingOfAnEstimatorThatCouldNotBeMade) {
  Host& program = host();
  Config config = host_config();
  config.weights = scratch_.path() / "none.fdw";
  EXPECT_FALSE(Estimator::create(config, program.handed_over()));
}

/// Counts what goes through the host's allocation callbacks.
struct Counted {
  std::atomic<long> alive = 0;
  std::atomic<long> made = 0;

  static void* allocate(void* self, std::size_t bytes, std::size_t alignment,
                        VkSystemAllocationScope) {
    void* memory = nullptr;
    if (::posix_memalign(&memory, std::max(alignment, sizeof(void*)), bytes) != 0) return nullptr;
    ++static_cast<Counted*>(self)->alive;
    ++static_cast<Counted*>(self)->made;
    return memory;
  }
  static void release(void* self, void* memory) {
    if (memory != nullptr) --static_cast<Counted*>(self)->alive;
    std::free(memory);
  }
  static void* again(void* self, void* memory, std::size_t bytes, std::size_t alignment,
                     VkSystemAllocationScope scope) {
    if (memory == nullptr) return allocate(self, bytes, alignment, scope);
    return std::realloc(memory, bytes);  // NOLINT: of no more than malloc's alignment here
  }
};

TEST_F(HostTest, SeesItsOwnAllocatorUsedForAllObjects) {
  Counted counted;
  VkAllocationCallbacks callbacks{};
  callbacks.pUserData = &counted;
  callbacks.pfnAllocation = &Counted::allocate;
  callbacks.pfnReallocation = &Counted::again;
  callbacks.pfnFree = &Counted::release;
  Host& program = host();
  {
    VulkanHost given = program.handed_over();
    given.allocation = &callbacks;
    auto made = Estimator::create(host_config(), given);
    callbacks = {};  // they were copied
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->estimate(wave_.frame()));
    EXPECT_GT(counted.alive, 10);
  }
  EXPECT_GT(counted.made, 10);
  EXPECT_EQ(counted.alive, 0);
}

TEST_F(HostTest, IsToldWhatItsDeviceMustBeMadeWith) {
  for (const std::uint32_t version : {VK_API_VERSION_1_1, VK_API_VERSION_1_3}) {
    Host& program = host({.api_version = version});
    const VulkanNeeds& needs = program.needs();
    EXPECT_THAT(needs.lacks, ::testing::IsEmpty());
    EXPECT_THAT(needs.queue_families, ::testing::Contains(program.queue_family()));
    std::vector<std::string> extensions(needs.extensions.begin(), needs.extensions.end());
    if (version == VK_API_VERSION_1_3) {
      EXPECT_THAT(extensions, Not(::testing::Contains("VK_KHR_timeline_semaphore")));
      EXPECT_THAT(extensions, Not(::testing::Contains("VK_EXT_subgroup_size_control")));
    } else if (needs.wanted.timeline_semaphore) {
      EXPECT_THAT(extensions, ::testing::Contains("VK_KHR_timeline_semaphore"));
    }
    EXPECT_TRUE(Estimator::create(host_config(), program.handed_over()));
    end_host();
  }
}

TEST_F(HostTest, HearsOfEveryFaultOfWhatItHandsOver) {
  const auto nothing = Estimator::create(host_config(), VulkanHost());
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::kBadInput);
  for (const char* const field :
       {"get_instance_proc_addr", "instance", "physical_device", "device"}) {
    EXPECT_THAT(nothing.error().message, HasSubstr("VulkanHost." + std::string(field) + ":"));
  }
  const auto unasked = vulkan_needs(VulkanHost());
  ASSERT_FALSE(unasked);
  EXPECT_EQ(unasked.error().code, ErrorCode::kBadInput);

  Host& program = host();
  const std::map<std::string, void (*)(VulkanHost&)> faults = {
      {"api_version: expected an instance of Vulkan 1.1 or later, got 1.0.0",
       [](VulkanHost& given) { given.api_version = VK_API_VERSION_1_0; }},
      {"lock, unlock: expected both or neither, got one",
       [](VulkanHost& given) { given.unlock = nullptr; }},
      {"allocation: expected pfnAllocation",
       [](VulkanHost& given) {
         static const VkAllocationCallbacks none{};
         given.allocation = &none;
       }},
      {"get_instance_proc_addr: Vulkan loader: expected vkDestroyInstance, found none",
       [](VulkanHost& given) {
         given.get_instance_proc_addr = [](VkInstance, const char*) -> PFN_vkVoidFunction {
           return nullptr;
         };
       }}};
  for (const auto& [words, spoil] : faults) {
    VulkanHost given = program.handed_over();
    spoil(given);
    const auto refused = Estimator::create(host_config(), given);
    ASSERT_FALSE(refused) << words;
    EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
    EXPECT_THAT(refused.error().message, HasSubstr("VulkanHost." + words));
  }
  Config config = host_config();
  config.device = "cpu";
  const auto contradicted = Estimator::create(config, program.handed_over());
  ASSERT_FALSE(contradicted);
  EXPECT_EQ(contradicted.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(contradicted.error().message, HasSubstr("Config.device: expected \"auto\""));
}

TEST_F(HostTest, HearsOfAQueueThatIsNotThere) {
  Host& program = host();
  VulkanHost given = program.handed_over();
  given.queue_family = 77;
  const auto refused = Estimator::create(host_config(), given);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoDevice);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("VulkanHost.device"), HasSubstr("lacks queue family 77 (has ")));
}

}  // namespace
}  // namespace flowdlo::testing
