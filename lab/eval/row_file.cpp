#include "eval/row_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/regular_file.hpp"

namespace flowdlo::eval {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30U;  // a million rows and more

std::vector<std::size_t> lacking_rows(const RunInfo& info,
                                      const std::map<std::size_t, Trial>& trials) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < info.frames.size(); ++row) {
    if (info.shard.owns(row) && trials.count(row) == 0) rows.push_back(row);
  }
  return rows;
}

Result<void> add_row(std::string_view line, const std::string& who, RowFileContent& content) {
  auto row = parse_row(line, who);
  if (!row) return row.error();
  const bool known = row->index < content.info.frames.size() &&
                     content.info.shard.owns(row->index) &&
                     row->trial.name == content.info.frames[row->index];
  if (!known || !content.trials.emplace(row->index, std::move(row->trial)).second) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected a row of its first line's frames, each once, got row {} "
                             "again or from elsewhere; remove the file and evaluate again",
                             who, row->index)};
  }
  return {};
}

}  // namespace

std::vector<std::size_t> RowFileContent::lacking() const { return lacking_rows(info, trials); }

Result<RowFileContent> read_row_file(const fs::path& file) {
  const auto whole = files::read_text(file, kMostBytes);
  if (!whole) return whole.error();
  const std::string& text = *whole;
  RowFileContent content;
  int number = 0;
  for (std::size_t begin = 0;;) {
    const auto end = text.find('\n', begin);
    if (end == std::string::npos) break;
    const auto line = std::string_view(text).substr(begin, end - begin);
    const auto who = fmt::format("{}:{}", file.string(), ++number);
    if (number == 1) {
      auto info = parse_run_info(line, who);
      if (!info) return info.error();
      content.info = *std::move(info);
    } else if (auto added = add_row(line, who, content); !added) {
      return added.error();
    }
    begin = end + 1;
    content.whole_bytes = begin;
  }
  return content;
}

Result<RowFile> RowFile::open(const fs::path& folder, const RunInfo& info) {
  const fs::path path = folder / row_file_name(info.shard);
  const int descriptor =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0666);
  RowFile file(path, descriptor);
  if (descriptor < 0) return file.io_error("opened");
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: another run is writing it; wait for it, or choose another --out "
                             "or --shard",
                             path.string())};
  }
  if (auto taken = file.take_over(info); !taken) return taken.error();
  return file;
}

Result<void> RowFile::append(const Row& row) { return write_line(row_json(row)); }

RowFile::RowFile(fs::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

RowFile::RowFile(RowFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_),
      kept_(other.kept_),
      lacking_(std::move(other.lacking_)) {}

RowFile::~RowFile() {
  if (descriptor_ >= 0) ::close(descriptor_);  // gives the lock back as well
}

// Reads what an earlier run left, and leaves the file ready for the next row.
Result<void> RowFile::take_over(const RunInfo& info) {
  const auto found = read_row_file(path_);
  if (!found) return found.error();
  const bool whole_and_done = info.shard.whole() && found->lacking().empty();
  if (found->whole_bytes == 0 || whole_and_done) {
    lacking_ = lacking_rows(info, {});
    if (auto done = cut(0); !done) return done;
    return write_line(run_info_json(info));
  }
  const auto mine = parse_run_info(run_info_json(info), path_.string());  // as it would come back
  if (!mine) return mine.error();
  std::string other = difference(found->info, *mine);
  if (other.empty() && found->info.device != mine->device) {
    other = fmt::format("the device is {} and {}", found->info.device, mine->device);
  }
  if (!other.empty() || found->info.shard != mine->shard) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: holds rows of another run ({}); remove the file, or choose "
                             "another --out",
                             path_.string(), other.empty() ? "another shard" : other)};
  }
  kept_ = found->trials.size();
  lacking_ = found->lacking();
  return cut(found->whole_bytes);
}

Result<void> RowFile::cut(std::size_t bytes) {
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) return io_error("cut");
  bytes_ = bytes;
  return {};
}

Result<void> RowFile::write_line(std::string line) {
  line += '\n';
  std::string_view left = line;
  while (!left.empty()) {
    const auto written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const Error error = io_error("written");
      [[maybe_unused]] const auto tidied = cut(bytes_);  // the next run would drop it as well
      return error;
    }
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  bytes_ += line.size();
  return {};
}

Error RowFile::io_error(const std::string& what) const {
  return {ErrorCode::kIo, fmt::format("{}: cannot be {}: {}", path_.string(), what,
                                      std::generic_category().message(errno))};
}

}  // namespace flowdlo::eval
