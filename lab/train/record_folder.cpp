#include "train/record_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "survey/in_parallel.hpp"
#include "weights/sha256.hpp"

namespace flowdlo::train {
namespace {

std::filesystem::path shard_file(const std::filesystem::path& folder, Part part,
                                 std::uint32_t number) {
  return folder / fmt::format("{}-{:05}.records", name_of(part), number);
}

std::string origin_of(const SourceConfig& source, const RecordOptions& options) {
  return fmt::format("{} prior {}{}", describe(source),
                     options.prior_kind == weights::PriorKind::kThesis ? "thesis" : "refined",
                     options.with_depth ? " with depth" : "");
}

using Outcome = Result<std::optional<Record>>;

/// A record, or nothing where the engine has no estimate. What fails must end the whole run.
Outcome outcome_of(const SceneSource& source, const RecordOptions& options, Part part,
                   std::uint64_t index) {
  try {
    const auto frame = source(part, index);
    if (!frame) return frame.error();
    auto record = make_record(frame->labelled, options);
    if (record) return std::optional(*std::move(record));
    const ErrorCode code = record.error().code;
    if (code == ErrorCode::kNoPath || code == ErrorCode::kNoEvidence)
      return std::optional<Record>();
    return record.error();
  } catch (const std::exception& thrown) {
    return Error{ErrorCode::kInternal,
                 fmt::format("scene {} of {}: {}", index, name_of(part), thrown.what())};
  }
}

Error of_another_origin(const std::filesystem::path& file, const std::string& expected,
                        const std::string& got) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected records of \"{}\", got \"{}\"; give another folder, or delete "
                      "this one",
                      file.string(), expected, got)};
}

bool same(const Record& a, const Record& b) {
  return a.mask == b.mask && a.priors == b.priors && a.truth == b.truth &&
         a.visible.points_cam == b.visible.points_cam && a.visible.valid == b.visible.valid;
}

/// Whether the shards in `folder` are of this origin, and of this engine and scene maker: the first
/// record is made again.
Result<void> check_kept(const std::filesystem::path& file, const std::string& origin,
                        const SceneSource& source, const RecordOptions& options, Part part) {
  const auto shard = read_shard(file);
  if (!shard) return shard.error();
  if (shard->origin != origin) return of_another_origin(file, origin, shard->origin);
  if (shard->records.empty()) return {};
  const Record& kept = shard->records.front();
  const Outcome again = outcome_of(source, options, part, kept.index);
  if (!again) return again.error();
  if (*again && same(**again, kept)) return {};
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected the records that this program makes, got other ones of "
                           "scene {}; delete the folder: engine or scene maker have changed",
                           file.string(), kept.index)};
}

}  // namespace

Result<void> make_records(const std::filesystem::path& folder, Part part, std::uint64_t scenes,
                          const SourceConfig& source, const RecordOptions& options, int threads,
                          const Progress& progress) {
  const auto make_scene = scene_source(source);
  if (!make_scene) return make_scene.error();
  const std::uint64_t limit = scene_count(source, part);
  const std::uint64_t whole = (scenes + kShardScenes - 1) / kShardScenes * kShardScenes;
  const std::uint64_t total = limit > 0 ? std::min(whole, limit) : whole;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);

  const std::string origin = origin_of(source, options);
  std::uint32_t number = count_shards(folder, part);
  if (number > 0) {
    auto kept = check_kept(shard_file(folder, part, 0), origin, *make_scene, options, part);
    if (!kept) return kept;
  }
  for (;; ++number) {
    Shard shard;
    shard.origin = origin;
    shard.first = static_cast<std::uint64_t>(number) * kShardScenes;
    if (shard.first >= total) return {};
    shard.scenes =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(kShardScenes, total - shard.first));
    for (Outcome& outcome : survey::in_parallel<std::optional<Record>>(
             {shard.first, shard.scenes}, std::max(threads, 1), survey::no_tool,
             [&](survey::Nothing, std::uint64_t index) {
               return outcome_of(*make_scene, options, part, index);
             },
             progress)) {
      if (!outcome) return outcome.error();
      if (*outcome) {
        shard.records.push_back(**std::move(outcome));
      } else {
        ++shard.skipped;
      }
    }
    if (auto written = write_shard(shard, shard_file(folder, part, number)); !written) {
      return written;
    }
  }
}

std::uint32_t count_shards(const std::filesystem::path& folder, Part part) {
  std::uint32_t count = 0;
  std::error_code failed;
  while (std::filesystem::exists(shard_file(folder, part, count), failed)) ++count;
  return count;
}

Result<RecordSet> load_records(const std::filesystem::path& folder, Part part,
                               std::uint32_t most_shards) {
  RecordSet set;
  weights::Sha256 digests;
  const std::uint32_t count = std::min(most_shards, count_shards(folder, part));
  for (; set.shards < count; ++set.shards) {
    const auto file = shard_file(folder, part, set.shards);
    auto shard = read_shard(file);
    if (!shard) return shard.error();
    if (set.shards == 0) set.origin = shard->origin;
    if (shard->origin != set.origin) return of_another_origin(file, set.origin, shard->origin);
    set.scenes += shard->scenes;
    set.skipped += shard->skipped;
    const auto* digest = reinterpret_cast<const std::uint8_t*>(shard->sha256.data());
    digests.update({digest, shard->sha256.size()});
    for (Record& record : shard->records) set.records.push_back(std::move(record));
  }
  if (set.records.empty()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected {} records, got none; run flowdlo-train records",
                             folder.string(), name_of(part))};
  }
  set.sha256 = digests.finish();
  return set;
}

}  // namespace flowdlo::train
