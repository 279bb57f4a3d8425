#include "eval/job_loop.hpp"

#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "threads/team.hpp"

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
  if (workers.empty()) return {};
  threads::work_together(static_cast<int>(workers.size()), [&](int who) {
    while (const auto row = take()) {
      Trial trial = guarded(workers[static_cast<std::size_t>(who)], *row);
      const std::lock_guard lock(mutex);
      if (auto handed = done({*row, std::move(trial)}); !handed && !failure) {
        failure = handed.error();
      }
    }
  });
  if (failure) return *failure;
  return {};
}

}  // namespace flowdlo::eval
