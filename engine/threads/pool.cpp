#include "threads/pool.hpp"

#include <utility>

#include "threads/team.hpp"

namespace flowdlo::threads {

Pool::Pool(int threads) : helpers_(start(1, count(threads), [this](int) { serve(); })) {}

Pool::~Pool() {
  {
    const std::lock_guard held(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Pool::serve() {
  std::unique_lock held(mutex_);
  while (true) {
    changed_.wait(held, [this] { return ends_ || (at_ != nullptr && at_->has_more()); });
    if (ends_) return;
    at_->do_one(held);
  }
}

Beside::Beside(Pool& pool, int pieces, std::function<void(int)> work)
    : pool_(pool), pieces_(pieces), work_(std::move(work)) {
  if (pieces_ < 1) return;
  {
    const std::lock_guard held(pool_.mutex_);
    if (pool_.at_ != nullptr) return;
    pool_.at_ = this;
  }
  pool_.changed_.notify_all();
}

Beside::~Beside() {
  std::unique_lock held(pool_.mutex_);
  next_ = pieces_;
  pool_.changed_.wait(held, [this] { return under_way_ == 0; });
  if (pool_.at_ == this) pool_.at_ = nullptr;
}

void Beside::finish() {
  std::unique_lock held(pool_.mutex_);
  while (has_more()) do_one(held);
  pool_.changed_.wait(held, [this] { return under_way_ == 0; });
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void Beside::do_one(std::unique_lock<std::mutex>& held) {
  const int piece = next_++;
  ++under_way_;
  held.unlock();
  std::exception_ptr thrown;
  try {
    work_(piece);
  } catch (const std::exception&) {
    thrown = std::current_exception();
  }
  held.lock();
  if (thrown) thrown_ = thrown;
  --under_way_;
  if (under_way_ == 0 && !has_more()) pool_.changed_.notify_all();
}

void share_out(Pool* pool, int pieces, const std::function<void(int)>& work) {
  if (pool != nullptr && pieces > 1) {
    Beside(*pool, pieces, work).finish();
    return;
  }
  for (int piece = 0; piece < pieces; ++piece) work(piece);
}

}  // namespace flowdlo::threads
