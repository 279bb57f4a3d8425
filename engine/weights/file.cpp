#include "weights/file.hpp"

#include <fmt/format.h>

#include "files/shown_name.hpp"

namespace flowdlo::weights {

Result<files::FileBytes> read_file(const std::filesystem::path& file) {
  auto read = files::RegularFile::open(file);
  if (!read) return read.error();
  if (read->size() > kLargestFile) {
    return bad_weights(
        file, {fmt::format("expected at most {} bytes, got {}; give a FlowDLO weights file",
                           kLargestFile, read->size())});
  }
  return read->read(kLargestFile);
}

Error bad_weights(const std::filesystem::path& file, const std::vector<std::string>& faults) {
  std::string message;
  for (const std::string& fault : faults) {
    message += fmt::format("{}{}: {}", message.empty() ? "" : "\n", files::shown(file), fault);
  }
  return {ErrorCode::kBadWeights, message};
}

}  // namespace flowdlo::weights
