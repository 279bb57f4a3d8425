#include "threads/pool.hpp"

#include <algorithm>
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

Beside* Pool::newest(std::size_t first) const {
  for (std::size_t i = open_.size(); i > first; --i) {
    if (open_[i - 1]->has_more()) return open_[i - 1];
  }
  return nullptr;
}

void Pool::serve() {
  std::unique_lock held(mutex_);
  while (true) {
    changed_.wait(held, [this] { return ends_ || newest() != nullptr; });
    if (ends_) return;
    newest()->do_one(held);
  }
}

Beside::Beside(Pool& pool, int pieces, std::function<void(int)> work)
    : pool_(pool), pieces_(pieces), work_(std::move(work)) {
  if (pieces_ < 1) return;
  {
    const std::lock_guard held(pool_.mutex_);
    pool_.open_.push_back(this);
  }
  pool_.changed_.notify_all();
}

Beside::~Beside() {
  std::unique_lock held(pool_.mutex_);
  next_ = pieces_;
  pool_.changed_.wait(held, [this] { return under_way_ == 0; });
  std::erase(pool_.open_, this);
}

void Beside::finish() {
  std::unique_lock held(pool_.mutex_);
  while (has_more()) do_one(held);
  while (under_way_ > 0) {
    // What is newer was begun by a piece under way, or by somebody who waits for it.
    const auto place = std::find(pool_.open_.begin(), pool_.open_.end(), this);
    Beside* const newer = pool_.newest(static_cast<std::size_t>(place - pool_.open_.begin()));
    if (newer != nullptr) {
      newer->do_one(held);
    } else {
      pool_.changed_.wait(held);
    }
  }
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
