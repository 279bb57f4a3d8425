// Schedule: who does which part of a program, and when they wait for each other.
//
// Draws never look at each other. Where they divide evenly among the threads, each thread takes its
// draws through a whole segment of steps alone, and nobody waits until its end. Otherwise the
// threads share every step, and meet after each.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reference/crew.hpp"

namespace flowdlo::reference {

/// Some consecutive blocks of 64 rows, and one of several parts of the work on them.
struct Piece {
  int block = 0;  ///< the first
  int blocks = 1;
  int part = 0;
  int parts = 1;
};

struct Step {
  int blocks = 0;  ///< of 64 rows, independent of each other; 0: the step is one piece
  int parts = 1;   ///< that threads may share; used where there are fewer blocks than threads
  std::function<void(const Piece&)> work;
  /// Ids of tensors: read at other rows than the piece's own, and written.
  std::vector<std::uint32_t> reads_beyond;
  std::uint32_t writes = 0;
};

class Schedule {
 public:
  /// Steps from here on are timed under `name`; a name may come back.
  void stage(std::string_view name);
  void add(Step step);
  /// Ends recording: decides how `crew` shares the steps. Once.
  void settle(const Crew& crew);
  /// All steps once. Allocates nothing.
  void run(Crew& crew);
  /// Milliseconds of the last run by stage, in order of first appearance.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& times_ms() const {
    return times_ms_;
  }

 private:
  /// Consecutive steps on the same blocks, none of which reads beyond its rows what another writes.
  struct Segment {
    std::size_t begin = 0;
    std::size_t end = 0;
    int blocks = 0;
    int together = 0;  ///< blocks that one thread takes through the segment; 0: steps are shared
  };

  [[nodiscard]] bool belongs(const Segment& segment, const Step& step) const;
  void work(Crew& crew, int thread);
  void work_apart(const Segment& segment, std::atomic<int>& next, int thread);
  void work_shared(const Segment& segment, Crew& crew, int thread);

  std::vector<Step> steps_;
  std::vector<std::size_t> stage_of_;  // of each step
  std::size_t stage_ = 0;
  std::vector<Segment> segments_;
  std::unique_ptr<std::atomic<int>[]> next_;  // piece to take, of each step
  std::vector<double> busy_ms_;               // of the caller's thread in one segment, by stage
  std::vector<std::pair<std::string, double>> times_ms_;
};

}  // namespace flowdlo::reference
