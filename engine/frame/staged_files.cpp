#include "frame/staged_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

namespace flowdlo::frame {
namespace {

// The process number keeps two runs that write to one folder out of each other's files.
std::filesystem::path temporary_name(const std::filesystem::path& file) {
  std::filesystem::path name = file;
  name += fmt::format(".{}.tmp", ::getpid());
  return name;
}

}  // namespace

StagedFiles::~StagedFiles() {
  for (const auto& entry : temporary_and_final_) {
    std::error_code ignored;
    std::filesystem::remove(entry.first, ignored);
  }
}

Result<void> StagedFiles::add(const std::filesystem::path& file,
                              std::span<const std::uint8_t> bytes) {
  return add(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<void> StagedFiles::add(const std::filesystem::path& file, std::string_view text) {
  const auto temporary = temporary_name(file);
  temporary_and_final_.emplace_back(temporary, file);
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    return Error{ErrorCode::kIo,
                 file.string() + ": cannot be written; check the folder's permissions and space"};
  }
  return {};
}

Result<void> StagedFiles::commit() {
  while (!temporary_and_final_.empty()) {
    const auto [temporary, file] = temporary_and_final_.front();
    std::error_code failure;
    std::filesystem::rename(temporary, file, failure);
    if (failure) {
      return Error{ErrorCode::kIo, file.string() + ": cannot be replaced: " + failure.message()};
    }
    temporary_and_final_.erase(temporary_and_final_.begin());
  }
  return {};
}

}  // namespace flowdlo::frame
