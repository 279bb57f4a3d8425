#include "vulkan/kept_drivers.hpp"

#include <unistd.h>

#include <map>
#include <mutex>

#include "vulkan/instance.hpp"

namespace flowdlo::vulkan {
namespace {

class Kept {
 public:
  Kept() = default;
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  /// Made after the first driver was loaded, and so gone before that driver's own end.
  ~Kept() { leave_inherited(); }

  void keep(const std::string& driver, const std::shared_ptr<const Instance>& instance) {
    const std::lock_guard lock(mutex_);
    leave_inherited();
    instances_->emplace(driver, instance);
  }

  void forget() {
    const std::lock_guard lock(mutex_);
    leave_inherited();
    instances_->clear();
  }

 private:
  using Instances = std::map<std::string, std::shared_ptr<const Instance>>;

  /// A forked process has no driver behind what it inherited: that is left as it is.
  void leave_inherited() {
    if (process_ == ::getpid()) return;
    process_ = ::getpid();
    (void)instances_.release();
    instances_ = std::make_unique<Instances>();
  }

  std::mutex mutex_;
  pid_t process_ = ::getpid();
  std::unique_ptr<Instances> instances_ = std::make_unique<Instances>();
};

Kept& kept() {
  static Kept drivers;
  return drivers;
}

}  // namespace

void keep_driver(const std::string& driver, const std::shared_ptr<const Instance>& instance) {
  kept().keep(driver, instance);
}

void forget_drivers() { kept().forget(); }

}  // namespace flowdlo::vulkan
