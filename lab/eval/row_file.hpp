// RowFile: the rows of one run or of one part of it, on disk from the moment they are known.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "eval/run_info.hpp"
#include "eval/trial_json.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// What a row file holds: a line that says what was run, then a line a row, in the order in which
/// they were done.
struct RowFileContent {
  RunInfo info;
  std::map<std::size_t, Trial> trials;  ///< by row
  std::size_t whole_bytes = 0;          ///< without the half line that a killed run may leave

  [[nodiscard]] std::vector<std::size_t> lacking() const;  ///< rows of its shard that are not there
};

/// A half last line counts as not written. Fails with kIo, or with kBadInput naming the line.
[[nodiscard]] Result<RowFileContent> read_row_file(const std::filesystem::path& file);

/// Open for one process at a time.
class RowFile {
 public:
  /// The file of `info.shard` in `folder`, which must exist. Rows of a stopped run are kept, and so
  /// are those of a part that is done; a whole run that is done starts over. Fails with kIo, and
  /// with kBadInput when another process has the file or its rows are of another run.
  [[nodiscard]] static Result<RowFile> open(const std::filesystem::path& folder,
                                            const RunInfo& info);

  /// One write: a killed process leaves a whole line, or a half one that the next run drops.
  Result<void> append(const Row& row);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::size_t kept() const { return kept_; }  ///< rows of an earlier run
  [[nodiscard]] const std::vector<std::size_t>& lacking() const { return lacking_; }  ///< at open()

  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&&) = delete;
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

 private:
  RowFile(std::filesystem::path path, int descriptor);
  Result<void> take_over(const RunInfo& info);
  Result<void> cut(std::size_t bytes);
  Result<void> write_line(std::string line);
  [[nodiscard]] Error io_error(const std::string& what) const;

  std::filesystem::path path_;
  int descriptor_;
  std::size_t bytes_ = 0;
  std::size_t kept_ = 0;
  std::vector<std::size_t> lacking_;
};

}  // namespace flowdlo::eval
