#include "train/loader.hpp"

#include <stdexcept>
#include <utility>

#include "threads/team.hpp"

namespace flowdlo::train {

Loader::Loader(std::shared_ptr<const RecordSet> records, const Recipe& recipe,
               const ViewConfig& view, std::uint64_t first_step, int threads)
    : records_(std::move(records)),
      recipe_(recipe),
      view_(view),
      plan_(records_->records, recipe.sampling, recipe.seed),
      ahead_(static_cast<std::size_t>(threads) + 1),
      to_make_(first_step),
      to_give_(first_step) {
  threads_ = threads::start(0, threads::count(threads), [this](int) { work(); });
  if (threads_.empty()) throw std::runtime_error("loader: expected a thread, got none");
}

Loader::~Loader() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Loader::work() {
  for (;;) {
    std::uint64_t step = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ending_ || to_make_ < to_give_ + ahead_; });
      if (ending_) return;
      step = to_make_++;
    }
    try {
      Batch batch = make_batch(records_->records, plan_, view_, step, recipe_.optimizer.batch,
                               recipe_.variant.local_channels);
      const std::lock_guard lock(mutex_);
      ready_.emplace(step, std::move(batch));
    } catch (...) {
      const std::lock_guard lock(mutex_);
      fault_ = std::current_exception();
    }
    changed_.notify_all();
  }
}

Batch Loader::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return fault_ != nullptr || ready_.contains(to_give_); });
  if (fault_ != nullptr) std::rethrow_exception(fault_);
  auto node = ready_.extract(to_give_++);
  lock.unlock();
  changed_.notify_all();
  return std::move(node.mapped());
}

}  // namespace flowdlo::train
