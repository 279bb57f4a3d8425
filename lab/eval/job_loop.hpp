// JobLoop: rows evaluated by several threads, handed over one at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "eval/trial_json.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Evaluates one row; each is called by one thread only.
using Worker = std::function<Trial(std::size_t row)>;

/// Calls `done` for every row of `rows`, from one thread at a time, in the order in which they are
/// finished. Workers for which no thread can be had stay idle. A worker that throws costs its row:
/// the trial's failure says what was thrown. Fails with the first error of `done`, once the rows
/// that were under way are over.
Result<void> run_jobs(std::span<const std::size_t> rows, const std::vector<Worker>& workers,
                      const std::function<Result<void>(Row)>& done);

}  // namespace flowdlo::eval
