#include "command/synth_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "durability_choice.hpp"
#include "files/regular_file.hpp"
#include "files/shown_name.hpp"
#include "files/staged_files.hpp"
#include "flowdlo/frame_folder.hpp"
#include "frame/centerline_csv.hpp"

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kUnfinished = ".unfinished-";

constexpr std::uint64_t kMostMetaBytes = 1U << 20U;

/// The folder at `path`, locked; closed where another holds it, or there is none.
files::Descriptor locked(const fs::path& path) {
  const auto& calls = files::kernel();
  files::Descriptor folder(
      calls.openat(AT_FDCWD, path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC, 0),
      calls);
  if (folder.is_open() && calls.flock(folder.get(), LOCK_EX | LOCK_NB) == 0) return folder;
  return {};
}

// Folders of runs that have ended, in whichever container: a run locks its own for as long as it
// lives.
void remove_left_behind(const fs::path& out) {
  std::error_code failure;
  for (fs::directory_iterator entry(out, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (!entry->path().filename().string().starts_with(kUnfinished)) continue;
    std::error_code ignored;
    if (locked(entry->path()).is_open()) fs::remove_all(entry->path(), ignored);
  }
}

Error not_made(const fs::path& out, const std::string& why) {
  return {ErrorCode::kIo, fmt::format("synth: {}: cannot be made: {}; choose another folder",
                                      files::shown(out), why)};
}

bool is_of(const nlohmann::json& json, const synth::Meta& meta) {
  return json.is_object() && json.value("split", "") == meta.split &&
         json.value("part", "") == meta.part && json.value("seed", ~meta.seed) == meta.seed &&
         json.value("index", ~meta.index) == meta.index && json.value("frame", -1) == meta.frame &&
         json.value("cords", false) == meta.cords && json.value("matched", false) == meta.matched;
}

}  // namespace

SynthFolder::SynthFolder(fs::path out, fs::path unfinished, files::Descriptor lock)
    : out_(std::move(out)), unfinished_(std::move(unfinished)), lock_(std::move(lock)) {}

SynthFolder::SynthFolder(SynthFolder&& other) noexcept
    : out_(std::move(other.out_)),
      unfinished_(std::exchange(other.unfinished_, fs::path())),
      lock_(std::move(other.lock_)) {}

SynthFolder::~SynthFolder() {
  if (unfinished_.empty()) return;
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
}

Result<SynthFolder> SynthFolder::open(const fs::path& out) {
  std::error_code failure;
  fs::create_directories(out, failure);
  if (failure) return not_made(out, failure.message());
  std::uint64_t bits = 0;
  if (files::kernel().random(bits) != 0) return not_made(out, "no random number");
  // It is locked before it has the name that others look for.
  const fs::path fresh = out / fmt::format(".flowdlo-{:016x}", bits);
  const fs::path unfinished = out / fmt::format("{}{:016x}", kUnfinished, bits);
  fs::create_directory(fresh, failure);
  if (failure) return not_made(out, failure.message());
  auto lock = locked(fresh);
  fs::rename(fresh, unfinished, failure);
  if (failure) return not_made(out, failure.message());
  remove_left_behind(out);
  return SynthFolder(out, unfinished, std::move(lock));
}

Result<bool> SynthFolder::holds(const synth::Meta& meta) const {
  const fs::path folder = out_ / synth::folder_name(meta);
  std::error_code failure;
  if (!fs::exists(folder, failure)) return false;
  const auto text = files::read_text(folder / "meta.json", kMostMetaBytes);
  const auto json =
      nlohmann::json::parse(text ? *text : std::string(), nullptr, /*allow_exceptions=*/false);
  if (!json.is_discarded() && is_of(json, meta)) return true;
  return Error{ErrorCode::kBadInput,
               fmt::format("synth: {}: expected nothing or the same frame (split {}, part {}, seed "
                           "{}{}{}), found another; choose another folder",
                           folder.string(), meta.split, meta.part, meta.seed,
                           meta.cords ? ", with cords" : "", meta.matched ? ", matched" : "")};
}

Result<void> SynthFolder::save(const synth::SyntheticFrame& frame) const {
  const std::string name = synth::folder_name(frame.meta);
  const fs::path temporary = unfinished_ / name;
  const auto durability = support::chosen_durability();
  const auto saved =
      save_frame_folder(temporary, frame.frame(), synth::kDepthScale_m, &frame.truth(), durability);
  if (!saved) return saved;
  files::StagedFiles staged(durability);
  if (auto added = staged.add(temporary / "meta.json", synth::meta_json(frame.meta)); !added) {
    return added;
  }
  for (std::size_t k = 1; k < frame.ropes.size(); ++k) {
    const auto file = temporary / fmt::format("truth_{}.csv", k);
    if (auto added = staged.add(file, frame::format_centerline(frame.ropes[k].nodes)); !added) {
      return added;
    }
  }
  if (auto done = staged.commit(); !done) return done;
  std::error_code failure;
  fs::rename(temporary, out_ / name, failure);
  if (!failure) return {};
  if (const auto there = holds(frame.meta); there && *there) return {};  // by another run's hand
  return Error{ErrorCode::kIo,
               fmt::format("synth: {}: cannot be put in its place: {}; choose another folder",
                           files::shown(out_ / name), failure.message())};
}

}  // namespace flowdlo::lab
