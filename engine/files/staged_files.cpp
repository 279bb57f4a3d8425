#include "files/staged_files.hpp"

#include <utility>

#include "files/shown_name.hpp"

namespace flowdlo::files {

Result<const Folder*> StagedFiles::folder_of(const std::filesystem::path& file) {
  auto& folder = folders_[file.parent_path()];
  if (folder == nullptr) {
    auto opened = Folder::open(file.parent_path(), *calls_);
    if (!opened) {
      return Error{opened.error().code,
                   shown(file) + ": cannot be written: " + opened.error().message};
    }
    folder = std::make_unique<Folder>(std::move(*opened));
  }
  return static_cast<const Folder*>(folder.get());
}

Result<void> StagedFiles::add(const std::filesystem::path& file,
                              std::span<const std::uint8_t> bytes) {
  const auto folder = folder_of(file);
  if (!folder) return folder.error();
  auto temporary =
      TemporaryFile::create(**folder, TemporaryKind::kSingle, file.filename().string());
  if (!temporary) return temporary.error();
  if (auto done = temporary->write(bytes); !done) return done;
  if (auto done = temporary->finish(durability_); !done) return done;
  files_.push_back(std::move(*temporary));
  return {};
}

Result<void> StagedFiles::add(const std::filesystem::path& file, std::string_view text) {
  return add(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<void> StagedFiles::commit() {
  for (TemporaryFile& file : files_) {
    if (auto done = file.take_place(); !done) return done;
  }
  files_.clear();
  for (const auto& [path, folder] : folders_) {
    if (auto done = folder->sync(durability_); !done) return done;
    sweep(*folder, TemporaryKind::kSingle);
  }
  return {};
}

}  // namespace flowdlo::files
