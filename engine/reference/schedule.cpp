#include "reference/schedule.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace flowdlo::reference {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostTogether = 2;    // blocks: their rows stay in the second-level cache
constexpr double kFairShare = 0.9;  // of the threads' time in use, below which steps are shared

double since_ms(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// How many blocks a thread should take through a segment, 0: too few for all threads to be busy.
int together(int blocks, int threads) {
  for (int count = kMostTogether; count > 0; --count) {
    if (blocks % count != 0) continue;
    const int pieces = blocks / count;
    const int rounds = (pieces + threads - 1) / threads;
    if (pieces >= kFairShare * rounds * threads) return count;
  }
  return 0;
}

}  // namespace

void Schedule::stage(std::string_view name) {
  const auto found = std::find_if(times_ms_.begin(), times_ms_.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  stage_ = static_cast<std::size_t>(found - times_ms_.begin());
  if (found == times_ms_.end()) times_ms_.emplace_back(name, 0.0);
}

void Schedule::add(Step step) {
  if (times_ms_.empty()) stage("");
  steps_.push_back(std::move(step));
  stage_of_.push_back(stage_);
}

bool Schedule::belongs(const Segment& segment, const Step& step) const {
  if (step.blocks == 0 || step.blocks != segment.blocks) return false;
  const auto holds = [](const std::vector<std::uint32_t>& ids, std::uint32_t id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  return std::none_of(
      steps_.begin() + static_cast<std::ptrdiff_t>(segment.begin),
      steps_.begin() + static_cast<std::ptrdiff_t>(segment.end), [&](const Step& earlier) {
        return holds(step.reads_beyond, earlier.writes) || holds(earlier.reads_beyond, step.writes);
      });
}

void Schedule::settle(const Crew& crew) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (segments_.empty() || !belongs(segments_.back(), steps_[i])) {
      const int blocks = steps_[i].blocks;
      segments_.push_back({i, i, blocks, blocks > 0 ? together(blocks, crew.size()) : 0});
    }
    segments_.back().end = i + 1;
  }
  next_ = std::make_unique<std::atomic<int>[]>(steps_.size());
  busy_ms_.resize(times_ms_.size());
}

/// Each thread takes some blocks at a time through all steps.
void Schedule::work_apart(const Segment& segment, std::atomic<int>& next, int thread) {
  if (thread == 0) std::fill(busy_ms_.begin(), busy_ms_.end(), 0.0);
  const int pieces = segment.blocks / segment.together;
  for (int piece = next.fetch_add(1); piece < pieces; piece = next.fetch_add(1)) {
    for (std::size_t i = segment.begin; i < segment.end; ++i) {
      const auto step_begin = Clock::now();
      steps_[i].work({.block = piece * segment.together, .blocks = segment.together});
      if (thread == 0) busy_ms_[stage_of_[i]] += since_ms(step_begin);
    }
  }
}

/// All threads take pieces of one step, then of the next.
void Schedule::work_shared(const Segment& segment, Crew& crew, int thread) {
  for (std::size_t i = segment.begin; i < segment.end; ++i) {
    const auto begin = Clock::now();
    const Step& step = steps_[i];
    const int parts = step.blocks > 0 ? step.parts : 1;
    const int pieces = std::max(step.blocks, 1) * parts;
    for (int piece = next_[i].fetch_add(1); piece < pieces; piece = next_[i].fetch_add(1)) {
      step.work({.block = piece / parts, .blocks = 1, .part = piece % parts, .parts = parts});
    }
    crew.meet();
    if (thread == 0) times_ms_[stage_of_[i]].second += since_ms(begin);
  }
}

void Schedule::work(Crew& crew, int thread) {
  for (const Segment& segment : segments_) {
    if (segment.together == 0) {
      work_shared(segment, crew, thread);
      continue;
    }
    const auto begin = Clock::now();
    work_apart(segment, next_[segment.begin], thread);
    crew.meet();
    if (thread > 0) continue;
    // The segment's time, divided as the caller's thread spent its own.
    const double busy_ms = std::accumulate(busy_ms_.begin(), busy_ms_.end(), 0.0);
    const double stretch = busy_ms > 0 ? since_ms(begin) / busy_ms : 0;
    for (std::size_t stage = 0; stage < busy_ms_.size(); ++stage) {
      times_ms_[stage].second += stretch * busy_ms_[stage];
    }
  }
}

void Schedule::run(Crew& crew) {
  for (auto& entry : times_ms_) entry.second = 0;
  for (std::size_t i = 0; i < steps_.size(); ++i) next_[i].store(0, std::memory_order_relaxed);
  crew.run([&](int thread) { work(crew, thread); });
}

}  // namespace flowdlo::reference
