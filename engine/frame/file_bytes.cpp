#include "frame/file_bytes.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <system_error>

namespace flowdlo::frame {
namespace {

// A pipe or a device would block or never end, so only regular files are opened.
Result<std::size_t> regular_file_size(const std::filesystem::path& file) {
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (status.type() == std::filesystem::file_type::not_found) {
    return Error{ErrorCode::kIo, file.string() + ": expected a file, found none; add it"};
  }
  if (failure) return Error{ErrorCode::kIo, file.string() + ": " + failure.message()};
  if (status.type() != std::filesystem::file_type::regular) {
    const bool folder = status.type() == std::filesystem::file_type::directory;
    return Error{ErrorCode::kIo, fmt::format("{}: expected a file, got {}; replace it",
                                             file.string(), folder ? "a folder" : "a device")};
  }
  const auto bytes = std::filesystem::file_size(file, failure);
  if (failure) return Error{ErrorCode::kIo, file.string() + ": " + failure.message()};
  return static_cast<std::size_t>(bytes);
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& file,
                                            std::size_t max_bytes) {
  const auto size = regular_file_size(file);
  if (!size) return size.error();
  if (*size == 0) {
    return Error{ErrorCode::kBadInput, file.string() + ": the file is empty; write it again"};
  }
  if (*size > max_bytes) {
    return Error{ErrorCode::kBadInput, fmt::format("{}: expected at most {} bytes, got {}",
                                                   file.string(), max_bytes, *size)};
  }
  std::vector<std::uint8_t> bytes(*size);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) {
    return Error{ErrorCode::kIo, file.string() + ": cannot be read; check its permissions"};
  }
  return bytes;
}

}  // namespace flowdlo::frame
