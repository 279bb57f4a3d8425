#include "estimator/comeback.hpp"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

namespace flowdlo::estimator {

Comeback::Comeback(Try once, Pace pace) : once_(std::move(once)), pace_(pace) {
  try {
    thread_ = std::thread([this] { go_on(); });
  } catch (const std::system_error&) {  // no more threads to be had
  }
}

Comeback::~Comeback() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Comeback::go_on() {
  auto pause = pace_.first;
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, pause, [&] { return ends_; })) {
    lock.unlock();
    std::optional<OnDevice> found;
    try {
      found = once_();
    } catch (const std::exception&) {  // no memory: it may have some later
    }
    lock.lock();
    if (found) {
      found_ = std::move(found);
      return;
    }
    pause = std::min(2 * pause, pace_.longest);
  }
}

std::optional<OnDevice> Comeback::take() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::exchange(found_, std::nullopt) : std::nullopt;
}

}  // namespace flowdlo::estimator
