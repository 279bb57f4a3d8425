#include "eval/job_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;

Trial named(std::size_t row) {
  Trial trial;
  trial.name = std::to_string(row);
  return trial;
}

TEST(JobLoop, EveryRowIsDoneOnceWhateverTheNumberOfWorkers) {
  const std::vector<std::size_t> rows{3, 5, 7, 11, 13, 17, 19};
  for (const std::size_t count : {1U, 2U, 16U}) {
    std::multiset<std::size_t> seen;
    const std::vector<Worker> workers(count, named);
    const auto ran = run_jobs(rows, workers, [&](const Row& row) -> Result<void> {
      EXPECT_EQ(row.trial.name, std::to_string(row.index));
      seen.insert(row.index);
      return {};
    });
    EXPECT_TRUE(ran);
    EXPECT_EQ(seen, std::multiset<std::size_t>(rows.begin(), rows.end()));
  }
}

TEST(JobLoop, WorkerThatThrowsCostsItsRowOnly) {
  const std::vector<std::size_t> rows{0, 1, 2};
  const Worker worker = [](std::size_t row) -> Trial {
    if (row == 1) throw std::runtime_error("no room left");
    return named(row);
  };
  std::vector<std::string> failures(3);
  const auto ran = run_jobs(rows, {worker}, [&](const Row& row) -> Result<void> {
    failures[row.index] = row.trial.failure;
    return {};
  });
  EXPECT_TRUE(ran);
  EXPECT_EQ(failures[0], "");
  EXPECT_THAT(failures[1], HasSubstr("no room left"));
  EXPECT_EQ(failures[2], "");
}

TEST(JobLoop, RowThatCannotBeKeptEndsTheRun) {
  const std::vector<std::size_t> rows{0, 1, 2, 3};
  int kept = 0;
  const auto ran = run_jobs(rows, {named}, [&](const Row& row) -> Result<void> {
    if (row.index == 1) return Error{ErrorCode::kIo, "the disk is full"};
    ++kept;
    return {};
  });
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().message, "the disk is full");
  EXPECT_EQ(kept, 1);
}

}  // namespace
}  // namespace flowdlo::eval
