#include "eval/merged_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "eval/row_file.hpp"

namespace flowdlo::eval {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNamed = 5;  // frames that a complaint lists

bool is_row_file(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "rows.jsonl" || (name.starts_with("rows-") && name.ends_with(".jsonl"));
}

Result<std::vector<fs::path>> row_files_of(const fs::path& source) {
  std::error_code failure;
  if (!fs::is_directory(source, failure)) return std::vector<fs::path>{source};
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(source, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (is_row_file(entry->path())) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  if (!files.empty()) return files;
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected the rows of a flowdlo eval (rows.jsonl, or rows-1-of-4."
                           "jsonl and its like), got none; give the --out of its shards",
                           source.string())};
}

// But for its time, which no two runs share.
std::string timeless(std::size_t index, Trial trial) {
  trial.total_ms = 0;
  return row_json({index, std::move(trial)});
}

struct Parts {
  RunInfo info;
  fs::path first;
  std::set<std::string> devices;
  std::map<std::size_t, Trial> trials;
  std::map<std::size_t, fs::path> origins;
};

Result<void> add_part(const fs::path& file, Parts& parts) {
  const auto content = read_row_file(file);
  if (!content) return content.error();
  if (content->whole_bytes == 0) return {};  // stopped before its first line
  if (parts.first.empty()) {
    parts.first = file;
    parts.info = content->info;
  }
  if (const auto other = difference(parts.info, content->info); !other.empty()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{} and {}: expected the rows of one evaluation, but {}; merge those "
                             "of one run only",
                             parts.first.string(), file.string(), other)};
  }
  parts.devices.insert(content->info.device);
  for (const auto& [index, trial] : content->trials) {
    const auto [found, is_new] = parts.trials.emplace(index, trial);
    if (is_new) {
      parts.origins[index] = file;
    } else if (timeless(index, found->second) != timeless(index, trial)) {
      return Error{ErrorCode::kBadInput,
                   fmt::format("{} and {}: have different rows for frame \"{}\"; remove one",
                               parts.origins[index].string(), file.string(), trial.name)};
    }
  }
  return {};
}

// Empty when every frame has its row.
std::string lacking_words(const Parts& parts) {
  std::string names;
  std::size_t count = 0;
  for (std::size_t row = 0; row < parts.info.frames.size(); ++row) {
    if (parts.trials.count(row) > 0) continue;
    if (count < kNamed) names += (count > 0 ? ", " : "") + parts.info.frames[row];
    ++count;
  }
  if (count == 0) return {};
  return fmt::format("{} of {} rows are lacking: {}{}", count, parts.info.frames.size(), names,
                     count > kNamed ? ", ..." : "");
}

}  // namespace

Result<MergedRows> merge_rows(const std::vector<fs::path>& sources) {
  Parts parts;
  for (const fs::path& source : sources) {
    const auto files = row_files_of(source);
    if (!files) return files.error();
    for (const fs::path& file : *files) {
      if (auto added = add_part(file, parts); !added) return added.error();
    }
  }
  const auto lacking = lacking_words(parts);
  if (parts.first.empty() || !lacking.empty()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("eval: {}; run the shards that were stopped again, or name the "
                             "folders that are missing",
                             lacking.empty() ? "there are no rows" : lacking)};
  }
  MergedRows merged;
  merged.info = std::move(parts.info);
  for (const std::string& device : parts.devices) {
    merged.devices += (merged.devices.empty() ? "" : " and ") + device;
  }
  for (auto& [index, trial] : parts.trials) merged.trials.push_back(std::move(trial));
  return merged;
}

}  // namespace flowdlo::eval
