#include "files/open_together.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>

#include "files/commit_record.hpp"
#include "files/failure.hpp"
#include "files/folder.hpp"
#include "files/shown_name.hpp"
#include "files/uninterrupted.hpp"

namespace flowdlo::files {
namespace {

constexpr int kMostAttempts = 200;
constexpr int kLongestPause_ms = 10;

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

TogetherFile open_name(const Folder& folder, const std::string& name, const std::string& shown_as,
                       int flags = 0) {
  const auto there = folder.status(name);
  if (!there) return {std::nullopt, there.error()};
  if (!*there) return {};
  auto file = RegularFile::open(folder.descriptor(), name.c_str(), folder.path() / shown_as,
                                folder.calls(), flags);
  if (file) return {std::move(*file), std::nullopt};
  if (const auto still = folder.status(name); still && !*still) return {};  // renamed in between
  return {std::nullopt, file.error()};
}

TogetherFile open_one(const Folder& folder, const CommitRecord* record, const std::string& name) {
  if (record != nullptr && record->removes_name(name)) return {};
  if (const auto* put = record == nullptr ? nullptr : record->put_of(name); put != nullptr) {
    auto waiting = open_name(folder, put->temporary, name, O_NOFOLLOW);
    if (waiting.file || waiting.error) return waiting;
  }
  return open_name(folder, name, name);
}

// Whether `name` still denotes what was opened, or still nothing.
bool stands(const Folder& folder, const std::string& name, const TogetherFile& opened) {
  struct stat now {};
  const int got = uninterrupted(
      [&] { return folder.calls().fstatat(folder.descriptor(), name.c_str(), now, 0); });
  if (got != 0) return !opened.file && (errno == ENOENT || opened.error);
  return opened.file ? is_same(now, opened.file->status()) : opened.error.has_value();
}

/// Whether nothing changed since `found` was found. With no record the moment is this one: each
/// name denotes the file that was opened from before it until after it. With one, the folder is
/// what the record says for as long as that is there.
Result<bool> is_one_moment(const Folder& folder, const FoundRecord& found,
                           std::span<const char* const> names,
                           const std::vector<TogetherFile>& opened) {
  const auto record = folder.status(kRecordName);
  if (!record) return record.error();
  if (found.record) return *record && is_same(**record, found.file->status());
  if (*record) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!stands(folder, names[i], opened[i])) return false;
  }
  return true;
}

}  // namespace

Result<std::vector<TogetherFile>> open_together(const std::filesystem::path& path,
                                                std::span<const char* const> names,
                                                const SystemCalls& calls) {
  const auto folder = Folder::open(path, calls);
  if (!folder) return folder.error();
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (attempt > 0) calls.sleep_ms(std::min(attempt, kLongestPause_ms));
    const auto found = find_record(*folder);
    if (!found) return found.error();
    std::vector<TogetherFile> opened;
    for (const char* name : names) {
      opened.push_back(open_one(*folder, found->record ? &*found->record : nullptr, name));
    }
    const auto one_moment = is_one_moment(*folder, *found, names, opened);
    if (!one_moment) return one_moment.error();
    if (*one_moment) return opened;
  }
  return Error{ErrorCode::kIo, shown(path) +
                                   ": its files change all the time; read it when its writer is "
                                   "done"};
}

}  // namespace flowdlo::files
