#include "files/commit_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>

#include "files/shown_name.hpp"
#include "files/temporary_file.hpp"

namespace flowdlo::files {
namespace {

constexpr std::string_view kFirstLine = "flowdlo commit 1";
constexpr std::string_view kLastLine = "end";
constexpr std::uint64_t kMostBytes = 1U << 16U;

bool is_plain_name(std::string_view name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of(std::string_view("/\n\0", 3)) == std::string_view::npos;
}

// The text up to the next line's end, which is taken off.
std::optional<std::string_view> next_line(std::string_view& text) {
  const auto end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const auto line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

// "put TEMPORARY NAME", "remove NAME" or "key NAME".
bool take_line(std::string_view line, CommitRecord& record) {
  const auto space = line.find(' ');
  if (space == std::string_view::npos) return false;
  const auto verb = line.substr(0, space);
  const auto rest = line.substr(space + 1);
  if (verb == "put") {
    const auto second = rest.find(' ');
    if (second == std::string_view::npos) return false;
    const auto temporary = rest.substr(0, second);
    const auto name = rest.substr(second + 1);
    record.puts.push_back({std::string(temporary), std::string(name)});
    return is_temporary(temporary, TemporaryKind::kPart) && is_plain_name(name);
  }
  if (verb == "remove") {
    record.removes.emplace_back(rest);
  } else if (verb == "key" && record.key.empty()) {
    record.key = rest;
  } else {
    return false;
  }
  return is_plain_name(rest);
}

// What was renamed before is not there any more; what is nowhere is a loss.
Result<void> put_in_place(const Folder& folder, const CommitRecord::Put& put) {
  const auto waiting = folder.status(put.temporary);
  if (!waiting) return waiting.error();
  if (*waiting) return folder.rename(put.temporary, put.name);
  const auto placed = folder.status(put.name);
  if (!placed) return placed.error();
  if (*placed) return {};
  return Error{ErrorCode::kIo, shown(folder.path() / put.name) +
                                   ": expected a file, found none: it was removed while the folder "
                                   "changed; write the folder again"};
}

}  // namespace

const CommitRecord::Put* CommitRecord::put_of(std::string_view name) const {
  const auto found =
      std::find_if(puts.begin(), puts.end(), [&](const Put& put) { return put.name == name; });
  return found == puts.end() ? nullptr : &*found;
}

bool CommitRecord::removes_name(std::string_view name) const {
  return std::find(removes.begin(), removes.end(), name) != removes.end();
}

std::string format_record(const CommitRecord& record) {
  std::string text = fmt::format("{}\nkey {}\n", kFirstLine, record.key);
  for (const auto& put : record.puts) text += fmt::format("put {} {}\n", put.temporary, put.name);
  for (const auto& name : record.removes) text += fmt::format("remove {}\n", name);
  return text + fmt::format("{}\n", kLastLine);
}

std::optional<CommitRecord> parse_record(std::string_view text) {
  CommitRecord record;
  if (next_line(text) != kFirstLine) return std::nullopt;
  for (auto line = next_line(text); line; line = next_line(text)) {
    if (*line == kLastLine) {
      const bool whole = text.empty() && !record.key.empty();
      return whole ? std::optional(std::move(record)) : std::nullopt;
    }
    if (!take_line(*line, record)) return std::nullopt;
  }
  return std::nullopt;
}

Result<FoundRecord> find_record(const Folder& folder) {
  FoundRecord found;
  const auto there = folder.status(kRecordName);
  if (!there) return there.error();
  if (!*there) return found;
  const auto path = folder.path() / kRecordName;
  auto file = RegularFile::open(folder.descriptor(), kRecordName, path, folder.calls(), O_NOFOLLOW);
  if (!file) {
    const auto still = folder.status(kRecordName);
    if (still && !*still) return found;  // carried out in between
    return file.error();
  }
  const auto bytes = file->read(kMostBytes);
  if (!bytes) return bytes.error();
  found.record = parse_record(bytes->text());
  if (!found.record) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected the record of a change that was cut off, got something "
                             "else; remove it and write the folder again",
                             shown(path))};
  }
  found.file.emplace(std::move(*file));
  return found;
}

Result<void> carry_out(const Folder& folder, const CommitRecord& record, bool in_place,
                       Durability durability) {
  const CommitRecord::Put* key = record.put_of(record.key);
  if (key != nullptr) {
    const auto waiting = folder.status(key->temporary);
    if (!waiting) return waiting.error();
    if (!*waiting) key = nullptr;  // it has its name: only the rest is left
  }
  if (key != nullptr || record.removes_name(record.key)) {
    if (auto done = folder.remove(record.key); !done) return done;
  }
  for (const auto& put : record.puts) {
    if (put.name == record.key) continue;
    if (auto done = put_in_place(folder, put); !done) return done;
  }
  for (const auto& name : record.removes) {
    if (auto done = folder.remove(name); !done) return done;
  }
  if (key != nullptr) {
    if (auto done = folder.rename(key->temporary, key->name); !done) return done;
  }
  if (auto done = folder.sync(durability); !done || !in_place) return done;
  return folder.remove(kRecordName);
}

}  // namespace flowdlo::files
