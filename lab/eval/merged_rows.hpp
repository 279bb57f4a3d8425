// MergedRows: the rows of one evaluation from wherever its parts were written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "eval/run_info.hpp"
#include "eval/trial.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

struct MergedRows {
  RunInfo info;               ///< of the first part; its shard means nothing
  std::string devices;        ///< of all parts, in words
  std::vector<Trial> trials;  ///< one a frame of the data set, in its order
};

/// Row files, or folders of them. Fails with kIo, and with kBadInput when the parts are not of one
/// run, when rows are lacking (it says in which part), or when two parts have different rows for a
/// frame.
[[nodiscard]] Result<MergedRows> merge_rows(const std::vector<std::filesystem::path>& sources);

}  // namespace flowdlo::eval
