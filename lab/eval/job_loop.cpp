#include "eval/job_loop.hpp"

#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace flowdlo::eval {
namespace {

Trial guarded(const Worker& worker, std::size_t row) {
  Trial trial;
  try {
    return worker(row);
  } catch (const std::exception& fault) {
    trial.failure = std::string("eval: ") + fault.what();
  } catch (...) {
    trial.failure = "eval: the frame ended in an exception without a word";
  }
  return trial;
}

}  // namespace

Result<void> run_jobs(std::span<const std::size_t> rows, const std::vector<Worker>& workers,
                      const std::function<Result<void>(Row)>& done) {
  std::mutex mutex;
  std::size_t next = 0;
  std::optional<Error> failure;
  const auto take = [&]() -> std::optional<std::size_t> {
    const std::lock_guard lock(mutex);
    if (failure || next == rows.size()) return std::nullopt;
    return rows[next++];
  };
  const auto work = [&](const Worker& worker) {
    while (const auto row = take()) {
      Trial trial = guarded(worker, *row);
      const std::lock_guard lock(mutex);
      if (auto handed = done({*row, std::move(trial)}); !handed && !failure) {
        failure = handed.error();
      }
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < workers.size(); ++i) {
    threads.emplace_back(work, std::cref(workers[i]));
  }
  if (!workers.empty()) work(workers.front());
  threads.clear();  // joins
  if (failure) return *failure;
  return {};
}

}  // namespace flowdlo::eval
