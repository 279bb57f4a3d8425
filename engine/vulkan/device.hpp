// Device: one VkDevice with one compute queue, its function table and its kernels.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/result.hpp"
#include "vulkan/check.hpp"
#include "vulkan/gemm_choice.hpp"
#include "vulkan/instance.hpp"
#include "vulkan/kernel.hpp"
#include "vulkan/owned.hpp"
#include "vulkan/physical_device.hpp"

namespace flowdlo::vulkan {

/// A VkDevice that a host made and keeps, and its queue.
struct Lent {
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_index = 0;
  void (*lock)(void* user) = nullptr;  ///< around each submission; both, or neither
  void (*unlock)(void* user) = nullptr;
  void* user = nullptr;
  std::optional<VkAllocationCallbacks> allocation{};
  bool timeline = false;  ///< has timeline semaphores
};

/// Timeline semaphores with a value each.
struct Moments {
  std::vector<VkSemaphore> semaphores{};
  std::vector<std::uint64_t> values{};
};

/// What a submission waits for, and what comes once it is done.
struct Meeting {
  Moments waits{};
  Moments signals{};
};

/// Safe to share between threads.
class Device {
 public:
  /// The driver of a GPU is kept, see keep_driver().
  [[nodiscard]] static Result<std::shared_ptr<Device>> open(std::unique_ptr<Instance> instance,
                                                            const PhysicalDevice& physical);

  /// Never destroys the VkDevice, nor what `instance` borrows.
  [[nodiscard]] static Result<std::shared_ptr<Device>> adopt(std::unique_ptr<Instance> instance,
                                                             const PhysicalDevice& physical,
                                                             const Lent& lent);

  [[nodiscard]] const PhysicalDevice& facts() const { return facts_; }
  [[nodiscard]] const Instance& instance() const { return *instance_; }
  [[nodiscard]] const VolkDeviceTable& api() const { return api_; }
  [[nodiscard]] VkDevice handle() const { return handle_; }
  [[nodiscard]] VkPipelineCache pipeline_cache() const { return pipeline_cache_.get(); }

  /// What objects of this device are made and destroyed with.
  [[nodiscard]] const VkAllocationCallbacks* allocation() const {
    return lent_ && lent_->allocation ? &*lent_->allocation : nullptr;
  }
  /// Whether its submissions may meet timeline semaphores.
  [[nodiscard]] bool has_timelines() const { return lent_ && lent_->timeline; }

  /// The table's one entry that nobody calls directly: counted, and one caller at a time, in the
  /// host's lock where the device is lent. No `commands`: `meeting` alone.
  [[nodiscard]] Result<void> submit(VkCommandBuffer commands, VkFence fence,
                                    const Meeting& meeting = {});
  [[nodiscard]] std::uint64_t submit_count() const { return submits_; }

  /// The kernel of each spec, in order; those not yet known are compiled, several at a time. They
  /// live as long as the device. `compiled`, where given, receives how many were new.
  [[nodiscard]] Result<std::vector<const Kernel*>> kernels(std::span<const KernelSpec> specs,
                                                           int* compiled = nullptr);

  /// How dense layers run here, once known. Guarded by tuning_mutex.
  [[nodiscard]] std::mutex& tuning_mutex() { return tuning_mutex_; }
  [[nodiscard]] const std::optional<GemmChoice>& gemm() const { return gemm_; }
  void remember(const GemmChoice& choice) { gemm_ = choice; }

  /// vulkan::check with this device's name.
  [[nodiscard]] Result<void> check(VkResult result, std::string_view operation) const {
    return vulkan::check(result, operation, facts_.report.name);
  }

  /// Creates one object, owned and named.
  template <class Info, class Handle>
  [[nodiscard]] Result<Owned<Handle>> create(
      VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
      void(VKAPI_PTR* destroy)(VkDevice, Handle, const VkAllocationCallbacks*), const Info& info,
      VkObjectType type, std::string_view object_name) const {
    Handle object = VK_NULL_HANDLE;
    const VkResult result = make(handle_, &info, allocation(), &object);
    if (result != VK_SUCCESS) return failed(result, type, object_name);
    Owned<Handle> owned(handle_, object, destroy, allocation());
    name(type, object, object_name);
    return owned;
  }

  template <class Handle>
  void name(VkObjectType type, Handle object, std::string_view object_name) const {
    name_object(type, reinterpret_cast<std::uint64_t>(object), std::string(object_name));
  }

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

 private:
  Device(std::unique_ptr<Instance> instance, const PhysicalDevice& facts)
      : instance_(std::move(instance)), facts_(facts) {}

  [[nodiscard]] Result<void> create_device();
  [[nodiscard]] Result<void> complete(std::uint32_t queue_index);
  [[nodiscard]] Result<void> load_functions();
  [[nodiscard]] Error failed(VkResult result, VkObjectType type, std::string_view name) const;
  void name_object(VkObjectType type, std::uint64_t object, const std::string& name) const;

  std::shared_ptr<const Instance> instance_;
  PhysicalDevice facts_;
  std::optional<Lent> lent_;
  VkDevice handle_ = VK_NULL_HANDLE;
  VolkDeviceTable api_{};
  VkQueue queue_ = VK_NULL_HANDLE;
  std::mutex queue_mutex_;
  std::atomic<std::uint64_t> submits_ = 0;
  Owned<VkPipelineCache> pipeline_cache_;
  std::mutex kernels_mutex_;
  std::map<std::string, Kernel> kernels_;
  std::mutex tuning_mutex_;
  std::optional<GemmChoice> gemm_;
};

}  // namespace flowdlo::vulkan
