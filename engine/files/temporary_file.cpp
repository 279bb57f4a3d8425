#include "files/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "files/failure.hpp"
#include "files/uninterrupted.hpp"
#include "files/written.hpp"

namespace flowdlo::files {
namespace {

constexpr std::string_view kPrefix = ".flowdlo-";
constexpr std::size_t kDigits = 16;

std::string_view suffix(TemporaryKind kind) {
  return kind == TemporaryKind::kSingle ? ".tmp" : ".part";
}

}  // namespace

Result<TemporaryFile> TemporaryFile::create(const Folder& folder, TemporaryKind kind,
                                            std::string_view meant_for) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  constexpr int kAttempts = 16;  // two of 2^64 that are equal are no chance
  const SystemCalls& calls = folder.calls();
  int code = EEXIST;
  for (int attempt = 0; attempt < kAttempts && code == EEXIST; ++attempt) {
    std::uint64_t bits = 0;
    if (uninterrupted([&] { return calls.random(bits); }) != 0) {
      code = errno;
      break;
    }
    auto name = fmt::format("{}{:016x}{}", kPrefix, bits, suffix(kind));
    Descriptor descriptor(
        uninterrupted(
            [&] { return calls.openat(folder.descriptor(), name.c_str(), kFlags, kNewFile); }),
        calls);
    if (descriptor.is_open()) {
      return TemporaryFile(folder, std::move(name), std::move(descriptor), meant_for);
    }
    code = errno;
  }
  return failure(folder.path() / meant_for, "written", code);
}

TemporaryFile::TemporaryFile(const Folder& folder, std::string name, Descriptor descriptor,
                             std::string_view meant_for)
    : folder_(&folder),
      name_(std::move(name)),
      descriptor_(std::move(descriptor)),
      meant_for_(meant_for) {}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : folder_(other.folder_),
      name_(std::exchange(other.name_, std::string())),
      descriptor_(std::move(other.descriptor_)),
      meant_for_(std::move(other.meant_for_)) {}

TemporaryFile::~TemporaryFile() {
  if (!name_.empty()) (void)folder_->remove(name_);
}

Result<void> TemporaryFile::write(std::span<const std::uint8_t> bytes) {
  const int code = written(descriptor_.get(), bytes, folder_->calls());
  if (code != 0) return failure(folder_->path() / meant_for_, "written", code);
  return {};
}

Result<void> TemporaryFile::finish(Durability durability) {
  const int code = synced(descriptor_.get(), durability, folder_->calls());
  if (code != 0) return failure(folder_->path() / meant_for_, "brought to its disk", code);
  if (!descriptor_.close() && errno != EINTR) {
    return failure(folder_->path() / meant_for_, "written", errno);
  }
  return {};
}

Result<void> TemporaryFile::take_place() {
  auto renamed = folder_->rename(name_, meant_for_);
  if (renamed) keep();
  return renamed;
}

bool is_temporary(std::string_view name, TemporaryKind kind) {
  const std::string_view end = suffix(kind);
  if (name.size() != kPrefix.size() + kDigits + end.size()) return false;
  const std::string_view digits = name.substr(kPrefix.size(), kDigits);
  return name.substr(0, kPrefix.size()) == kPrefix &&
         name.substr(kPrefix.size() + kDigits) == end &&
         digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void sweep(const Folder& folder, TemporaryKind kind) {
  const auto names = folder.names();
  if (!names) return;
  const std::int64_t now_s = folder.calls().now_s();
  for (const std::string& name : *names) {
    if (!is_temporary(name, kind)) continue;
    const auto status = folder.status(name);
    if (!status || !*status) continue;
    const struct stat& file = **status;
    const bool ours = S_ISREG(file.st_mode) && file.st_uid == ::geteuid();
    if (ours && now_s - file.st_mtim.tv_sec > kStaleAge_s) (void)folder.remove(name);
  }
}

}  // namespace flowdlo::files
