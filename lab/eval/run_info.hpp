// RunInfo: what an evaluation was made of, so that only rows of one and the same are put together.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "eval/shard.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

struct RunInfo {
  /// Everything that rows depend on, by name: "draws", "steps", "seed", ... What evaluates more
  /// adds its own.
  std::map<std::string, std::string> settings;
  std::string weights;              ///< the file as it was named; empty: the one that ships
  std::string device;               ///< rows of several devices agree up to rounding only
  std::vector<std::string> frames;  ///< names of the whole data set, in the order of its rows
  Shard shard;
};

/// Settings of `config`, with the sum of the weights' tensors: their file may have been replaced.
[[nodiscard]] std::map<std::string, std::string> settings_of(const Config& config,
                                                             const std::string& weights_sha256);

/// In words, how settings and frames differ; empty when rows of `a` and `b` belong together. Shard,
/// device and the weights' path may differ.
[[nodiscard]] std::string difference(const RunInfo& a, const RunInfo& b);

/// One line of JSON, without its end.
[[nodiscard]] std::string run_info_json(const RunInfo& info);

/// Fails with kBadInput, naming `who`.
[[nodiscard]] Result<RunInfo> parse_run_info(std::string_view line, const std::string& who);

/// The title of tables.md and how the figures came about; `devices` in words.
[[nodiscard]] std::string heading(const RunInfo& info, const std::string& devices);

}  // namespace flowdlo::eval
