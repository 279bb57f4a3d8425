#include "files/folder_update.hpp"

#include <cerrno>
#include <utility>

#include "files/commit_record.hpp"
#include "files/failure.hpp"
#include "files/folder_lock.hpp"
#include "files/shown_name.hpp"

namespace flowdlo::files {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// What a killed writer began, and what it left.
Result<void> tidy(const Folder& folder, Durability durability) {
  const auto found = find_record(folder);
  if (!found && found.error().code == ErrorCode::kBadInput) {
    // Damaged by others, for records appear whole: its files are of no use, and new ones come.
    return folder.remove(kRecordName);
  }
  if (!found) return found.error();
  if (found->record) {
    if (auto done = carry_out(folder, *found->record, true, durability); !done) return done;
  }
  sweep(folder, TemporaryKind::kPart);
  return {};
}

}  // namespace

Result<FolderUpdate> FolderUpdate::begin(const std::filesystem::path& folder, std::string key,
                                         Durability durability, const SystemCalls& calls) {
  auto opened = Folder::make(folder, calls);
  if (!opened) return opened.error();
  return FolderUpdate(std::make_unique<Folder>(std::move(*opened)), std::move(key), durability);
}

Result<void> FolderUpdate::put(std::string_view name, std::span<const std::uint8_t> bytes) {
  auto file = TemporaryFile::create(*folder_, TemporaryKind::kPart, name);
  if (!file) return file.error();
  if (auto done = file->write(bytes); !done) return done;
  if (auto done = file->finish(durability_); !done) return done;
  puts_.push_back(std::move(*file));
  return {};
}

Result<void> FolderUpdate::put(std::string_view name, std::string_view text) {
  return put(name, bytes_of(text));
}

// What would stop the change half way: a folder in a file's place, a temporary file that is gone.
Result<void> FolderUpdate::check_places() const {
  for (const TemporaryFile& file : puts_) {
    const auto waiting = folder_->status(file.name());
    if (!waiting) return waiting.error();
    const auto place = folder_->status(file.meant_for());
    if (!place) return place.error();
    const auto path = folder_->path() / file.meant_for();
    if (!*waiting) return failure(path, "written", ENOENT);
    if (*place && S_ISDIR((*place)->st_mode)) return failure(path, "replaced", EISDIR);
  }
  for (const std::string& name : removes_) {
    const auto place = folder_->status(name);
    if (!place) return place.error();
    if (*place && S_ISDIR((*place)->st_mode)) {
      return failure(folder_->path() / name, "removed", EISDIR);
    }
  }
  return {};
}

// The moment of the change: before the rename all is old, after it all is new.
Result<void> FolderUpdate::write_record(std::string_view text) {
  auto file = TemporaryFile::create(*folder_, TemporaryKind::kPart, kRecordName);
  if (!file) return file.error();
  if (auto done = file->write(bytes_of(text)); !done) return done;
  if (auto done = file->finish(durability_); !done) return done;
  if (auto done = file->take_place(); !done) {
    (void)folder_->remove(kRecordName);  // a failure that was none must not stand
    return done;
  }
  return {};
}

Result<void> FolderUpdate::commit() {
  const auto lock = FolderLock::take(*folder_);
  if (!lock) return lock.error();
  if (auto done = tidy(*folder_, durability_); !done) return done;
  if (auto done = check_places(); !done) return done;

  CommitRecord record{key_, {}, removes_};
  for (const TemporaryFile& file : puts_) record.puts.push_back({file.name(), file.meant_for()});
  const auto key = folder_->status(key_);
  if (!key) return key.error();
  // Where the key is not there yet its coming is the moment, and where it goes for good its going:
  // neither asks for room on a disk that may be full.
  const bool in_place = key->has_value() && !record.removes_name(key_);
  if (in_place) {
    if (auto done = write_record(format_record(record)); !done) return done;
    for (TemporaryFile& file : puts_) file.keep();  // they are the record's now
    if (auto done = folder_->sync(durability_); !done) return done;
  }
  auto done = carry_out(*folder_, record, in_place, durability_);
  for (TemporaryFile& file : puts_) {
    if (done) file.keep();
  }
  return done;
}

}  // namespace flowdlo::files
