// InParallel: the same work on each of many scenes, on several threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "flowdlo/result.hpp"
#include "threads/team.hpp"

namespace flowdlo::survey {

/// Scenes `first` to first + count - 1.
struct Span {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// Where work needs none, and where it has no outcome.
using Nothing = std::monostate;
inline Result<Nothing> no_tool() { return Nothing(); }

/// What `work(tool, index)` gives of each scene, a Result<Outcome>, in their order. Each thread has
/// a tool of its own, which `make_tool()` gives as a Result; where it gives none, what that thread
/// would have done fails as it did. `done` is called after each, by one thread at a time.
/// `threads` 0: one a core.
template <class Outcome, class MakeTool, class Work>
std::vector<Result<Outcome>> in_parallel(Span scenes, int threads, const MakeTool& make_tool,
                                         const Work& work, const std::function<void()>& done = {}) {
  if (scenes.count == 0) return {};
  std::vector<std::optional<Result<Outcome>>> outcomes(scenes.count);
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  threads::work_together(threads::count(threads), [&](int) {
    auto tool = make_tool();
    for (std::uint64_t i = next++; i < scenes.count; i = next++) {
      if (tool) {
        outcomes[i].emplace(work(*tool, scenes.first + i));
      } else {
        outcomes[i].emplace(tool.error());
      }
      const std::lock_guard lock(mutex);
      if (done) done();
    }
  });
  std::vector<Result<Outcome>> all;
  all.reserve(outcomes.size());
  for (auto& outcome : outcomes) all.push_back(*std::move(outcome));
  return all;
}

}  // namespace flowdlo::survey
