// Pool: threads that outlive a frame, for work beside what their owner does. Libraries keep data
// for every thread that ever called them, OpenCV 1.2 kB for good: threads of a frame's own would
// cost a robot gigabytes a day.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace flowdlo::threads {

/// Not to be destroyed in a process that was forked from its own, where the threads are missing.
class Pool {
 public:
  /// count(threads) - 1 threads beside the caller's, or as many as can be started.
  explicit Pool(int threads);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// With the caller's.
  [[nodiscard]] int threads() const { return static_cast<int>(helpers_.size()) + 1; }

 private:
  friend class Beside;

  void serve();
  /// The newest of what is open from `first` on that has pieces to begin; null where none has.
  [[nodiscard]] class Beside* newest(std::size_t first = 0) const;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<class Beside*> open_;  // oldest first; guarded by mutex_, as all that they hold
  bool ends_ = false;
  std::vector<std::thread> helpers_;
};

/// A number of pieces of work, done by a pool's threads beside what the caller does. A piece may
/// begin such a thing itself: of several at a time the threads take the newest one's pieces first.
class Beside {
 public:
  /// Begins. `work` is called with 0 up to `pieces` - 1, each once, on any thread.
  Beside(Pool& pool, int pieces, std::function<void(int)> work);
  /// Waits for what has begun and leaves the rest.
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  /// Lends a hand, to what the pieces began as well; returns when all is done. Of what the pieces
  /// throw, one is thrown again here.
  void finish();

 private:
  friend class Pool;

  [[nodiscard]] bool has_more() const { return next_ < pieces_; }
  void do_one(std::unique_lock<std::mutex>& held);

  Pool& pool_;
  const int pieces_;
  const std::function<void(int)> work_;
  int next_ = 0;
  int under_way_ = 0;
  std::exception_ptr thrown_;
};

/// work(0) up to work(pieces - 1), each once, on a pool's threads, as far as they are free, and the
/// caller's; without a pool on the caller's alone. Of what the pieces throw, one is thrown again
/// here.
void share_out(Pool* pool, int pieces, const std::function<void(int)>& work);

}  // namespace flowdlo::threads
