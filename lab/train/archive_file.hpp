// ArchiveFile: what libtorch serialises, as a file that is there whole or not at all.
#pragma once

#include <fmt/format.h>
#include <torch/torch.h>

#include <exception>
#include <filesystem>

#include "files/temporary_file.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::train {

/// Lets `fill` put its content into an archive, which is written under a temporary name and then
/// renamed. Fails with kIo, also where `fill` throws.
template <class Fill>
Result<void> write_archive(const std::filesystem::path& file, const Fill& fill) {
  const auto folder = files::Folder::make(file.parent_path());
  if (!folder) return folder.error();
  auto temporary = files::TemporaryFile::create(*folder, files::TemporaryKind::kSingle,
                                                file.filename().string());
  if (!temporary) return temporary.error();
  Result<void> written;
  try {
    torch::serialize::OutputArchive archive;
    fill(archive);
    archive.save_to([&](const void* data, std::size_t size) -> std::size_t {
      if (written) written = temporary->write({static_cast<const std::uint8_t*>(data), size});
      return size;
    });
  } catch (const std::exception& thrown) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a writable place, got \"{}\"; check the "
                                             "folder",
                                             file.string(), thrown.what())};
  }
  if (written) written = temporary->finish(Durability::kSynced);
  if (written) written = temporary->take_place();
  if (!written) return written;
  files::sweep(*folder, files::TemporaryKind::kSingle);
  return folder->sync(Durability::kSynced);
}

}  // namespace flowdlo::train
