#include "synth_folder.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "flowdlo/frame_folder.hpp"
#include "frame/staged_files.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kUnfinished = ".unfinished-";

// Folders of runs that have ended; the number in the name is the process's.
void remove_left_behind(const fs::path& out) {
  std::error_code failure;
  for (fs::directory_iterator entry(out, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(kUnfinished)) continue;
    const std::string_view digits = std::string_view(name).substr(kUnfinished.size());
    pid_t process = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), process);
    if (read.ec != std::errc() || process <= 0 || ::kill(process, 0) == 0) continue;
    std::error_code ignored;
    fs::remove_all(entry->path(), ignored);
  }
}

bool is_of(const nlohmann::json& json, const synth::Meta& meta) {
  return json.is_object() && json.value("split", "") == meta.split &&
         json.value("part", "") == meta.part && json.value("seed", ~meta.seed) == meta.seed &&
         json.value("index", ~meta.index) == meta.index && json.value("frame", -1) == meta.frame;
}

}  // namespace

SynthFolder::SynthFolder(fs::path out, fs::path unfinished)
    : out_(std::move(out)), unfinished_(std::move(unfinished)) {}

SynthFolder::SynthFolder(SynthFolder&& other) noexcept
    : out_(std::move(other.out_)), unfinished_(std::exchange(other.unfinished_, fs::path())) {}

SynthFolder::~SynthFolder() {
  if (unfinished_.empty()) return;
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
}

Result<SynthFolder> SynthFolder::open(const fs::path& out) {
  const fs::path unfinished = out / fmt::format("{}{}", kUnfinished, ::getpid());
  std::error_code failure;
  fs::create_directories(unfinished, failure);
  if (failure) {
    return Error{ErrorCode::kIo, fmt::format("synth: {}: cannot be made: {}; choose another folder",
                                             out.string(), failure.message())};
  }
  remove_left_behind(out);
  return SynthFolder(out, unfinished);
}

Result<bool> SynthFolder::holds(const synth::Meta& meta) const {
  const fs::path folder = out_ / synth::folder_name(meta);
  std::error_code failure;
  if (!fs::exists(folder, failure)) return false;
  std::ifstream stream(folder / "meta.json");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_discarded() && is_of(json, meta)) return true;
  return Error{ErrorCode::kBadInput,
               fmt::format("synth: {}: expected nothing or the same frame (split {}, part {}, seed "
                           "{}), found another; choose another folder",
                           folder.string(), meta.split, meta.part, meta.seed)};
}

Result<void> SynthFolder::save(const synth::SyntheticFrame& frame) const {
  const std::string name = synth::folder_name(frame.meta);
  const fs::path temporary = unfinished_ / name;
  const auto saved =
      save_frame_folder(temporary, frame.frame(), synth::kDepthScale_m, &frame.truth());
  if (!saved) return saved;
  frame::StagedFiles staged;
  if (auto added = staged.add(temporary / "meta.json", synth::meta_json(frame.meta)); !added) {
    return added;
  }
  if (auto done = staged.commit(); !done) return done;
  std::error_code failure;
  fs::rename(temporary, out_ / name, failure);
  if (failure) {
    return Error{ErrorCode::kIo, fmt::format("synth: {}: cannot be put in its place: {}",
                                             (out_ / name).string(), failure.message())};
  }
  return {};
}

}  // namespace flowdlo::tools
