// CommitRecord: what a folder is about to become, in one small file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/folder.hpp"
#include "files/regular_file.hpp"

namespace flowdlo::files {

/// From the moment its record is there, a folder *is* what the record says: each of `puts` is found
/// under its temporary name or, once it was renamed, under its own; what `removes` names is gone.
/// Whoever locks the folder next carries out what is left and removes the record.
struct CommitRecord {
  struct Put {
    std::string temporary;
    std::string name;
  };
  std::string key;  ///< the file without which the folder is not whole: goes first, comes last
  std::vector<Put> puts;
  std::vector<std::string> removes;

  [[nodiscard]] const Put* put_of(std::string_view name) const;
  [[nodiscard]] bool removes_name(std::string_view name) const;
};

inline constexpr const char* kRecordName = ".flowdlo-commit";

[[nodiscard]] std::string format_record(const CommitRecord& record);

/// Nothing where `text` is not what format_record() wrote; no name in it leaves the folder.
[[nodiscard]] std::optional<CommitRecord> parse_record(std::string_view text);

/// The folder's record and the file it was read from; neither where there is none.
struct FoundRecord {
  std::optional<CommitRecord> record;
  std::optional<RegularFile> file;  ///< held open, so that no other file gets its number
};

/// Fails with kIo, or with kBadInput where the record is damaged.
[[nodiscard]] Result<FoundRecord> find_record(const Folder& folder);

/// Does what `record` says, or what is left of it, and removes it if it is `in_place`. The folder's
/// lock must be held. Fails with kIo; then it can be tried again.
[[nodiscard]] Result<void> carry_out(const Folder& folder, const CommitRecord& record,
                                     bool in_place, Durability durability);

}  // namespace flowdlo::files
