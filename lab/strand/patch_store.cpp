#include "strand/patch_store.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <type_traits>

#include "files/whole_file.hpp"
#include "synth/evenly_spread.hpp"
#include "threads/team.hpp"

namespace flowdlo::strand {
namespace {

constexpr std::uint64_t kMagic = 0x31304843544150ULL;  // "PATCH01"

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof(T));
  }
  template <class T>
  void put_all(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes_.insert(bytes_.end(), from, from + values.size() * sizeof(T));
  }
  [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  template <class T>
  void get(T& value) {
    if (bytes_.size() - at_ < sizeof(T)) {
      good_ = false;
      return;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
  }
  template <class T>
  void get_all(std::vector<T>& values) {
    std::uint64_t count = 0;
    get(count);
    if (!good_ || count > (bytes_.size() - at_) / sizeof(T)) {
      good_ = false;
      return;
    }
    values.resize(count);
    std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

void put(const Patch& patch, Writer& to) {
  to.put(patch.width);
  to.put(patch.height);
  to.put(patch.frame_scale);
  to.put(patch.focal_px);
  to.put(patch.rope_px);
  to.put_all(patch.color_bgr);
  to.put_all(patch.mask);
  to.put_all(patch.depth);
  to.put(static_cast<std::uint64_t>(patch.strands.size()));
  for (const Strand& strand : patch.strands) {
    to.put(strand.rope);
    to.put_all(strand.points);
    to.put(strand.begins);
    to.put(strand.ends);
  }
}

std::optional<Patch> get(Reader& from) {
  Patch patch;
  from.get(patch.width);
  from.get(patch.height);
  from.get(patch.frame_scale);
  from.get(patch.focal_px);
  from.get(patch.rope_px);
  from.get_all(patch.color_bgr);
  from.get_all(patch.mask);
  from.get_all(patch.depth);
  std::uint64_t strands = 0;
  from.get(strands);
  for (std::uint64_t i = 0; i < strands && from.good(); ++i) {
    Strand strand;
    from.get(strand.rope);
    from.get_all(strand.points);
    from.get(strand.begins);
    from.get(strand.ends);
    patch.strands.push_back(std::move(strand));
  }
  const auto pixels =
      static_cast<std::size_t>(patch.width) * static_cast<std::size_t>(patch.height);
  const bool whole = from.good() && patch.width > 0 && patch.height > 0 &&
                     patch.mask.size() == pixels && patch.depth.size() == pixels &&
                     patch.color_bgr.size() == 3 * pixels;
  return whole ? std::optional(std::move(patch)) : std::nullopt;
}

std::filesystem::path shard_file(const std::filesystem::path& folder, std::uint64_t shard) {
  return folder / fmt::format("patches_{:05}.bin", shard);
}

Result<void> make_shard(const std::filesystem::path& file, std::uint64_t shard,
                        const DataConfig& config, const std::function<void()>& progress) {
  std::vector<std::vector<std::uint8_t>> packed;
  for (std::uint64_t i = 0; i < kShardScenes; ++i) {
    const std::uint64_t scene = shard * kShardScenes + i;
    const auto split =
        synth::evenly_spread(config.several, scene) ? synth::Split::kSeveral : synth::Split::kWide;
    const auto patches = patches_of(split, synth::Part::kTraining, config.seed, scene, config.patch,
                                    synth::evenly_spread(config.matched, scene));
    if (!patches) return patches.error();
    for (const Patch& patch : *patches) {
      Writer writer;
      put(patch, writer);
      packed.push_back(std::move(writer.bytes()));
    }
    progress();
  }
  Writer head;  // magic, count, bytes of each
  head.put(kMagic);
  std::vector<std::uint64_t> sizes;
  for (const auto& bytes : packed) sizes.push_back(bytes.size());
  head.put_all(sizes);
  std::vector<std::span<const std::uint8_t>> parts{head.bytes()};
  for (const auto& bytes : packed) parts.emplace_back(bytes);
  return files::write_file(file, parts, Durability::kUnsynced);
}

Error damaged(const std::filesystem::path& file) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected patches as flowdlo-train field-patches writes them; remove the "
                      "file and make it again",
                      file.string())};
}

}  // namespace

Result<void> make_patches(const std::filesystem::path& folder, const DataConfig& config,
                          int threads, const std::function<void()>& progress) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a folder that can be made, got \"{}\"",
                                             folder.string(), failed.message())};
  }
  const std::uint64_t shards = (config.scenes + kShardScenes - 1) / kShardScenes;
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  Result<void> outcome;
  threads::work_together(threads, [&](int) {
    for (std::uint64_t shard = next++; shard < shards; shard = next++) {
      const auto file = shard_file(folder, shard);
      if (std::filesystem::exists(file)) {
        const std::lock_guard lock(mutex);
        for (std::uint64_t i = 0; i < kShardScenes; ++i) progress();
        continue;
      }
      const auto made = make_shard(file, shard, config, [&] {
        const std::lock_guard lock(mutex);
        progress();
      });
      if (made) continue;
      const std::lock_guard lock(mutex);
      outcome = made;
      next = shards;
    }
  });
  return outcome;
}

Result<PatchStore> PatchStore::open(const std::filesystem::path& folder) {
  PatchStore store;
  for (std::uint64_t shard = 0; std::filesystem::exists(shard_file(folder, shard)); ++shard) {
    const auto file = shard_file(folder, shard);
    std::ifstream stream(file, std::ios::binary);
    std::array<std::uint64_t, 2> head{};
    stream.read(reinterpret_cast<char*>(head.data()), sizeof(head));
    constexpr std::uint64_t kMost = 1000000;
    if (!stream || head[0] != kMagic || head[1] > kMost) return damaged(file);
    std::vector<std::uint64_t> sizes(head[1]);
    const auto bytes = sizes.size() * sizeof(std::uint64_t);
    stream.read(reinterpret_cast<char*>(sizes.data()), static_cast<std::streamsize>(bytes));
    if (!stream) return damaged(file);
    std::uint64_t offset = sizeof(head) + bytes;
    for (const std::uint64_t size : sizes) {
      store.places_.push_back({store.shards_.size(), offset, size});
      offset += size;
    }
    if (offset != std::filesystem::file_size(file)) return damaged(file);
    store.shards_.push_back(file);
  }
  if (!store.places_.empty()) return store;
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected patches, got none; make some with flowdlo-train "
                           "field-patches",
                           folder.string())};
}

Result<Patch> PatchStore::read(std::size_t index) const {
  const Place& place = places_[index];
  const auto& file = shards_[place.shard];
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(place.offset));
  std::vector<std::uint8_t> bytes(place.bytes);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a readable file", file.string())};
  }
  Reader reader(bytes);
  auto patch = get(reader);
  if (!patch) return damaged(file);
  return *std::move(patch);
}

}  // namespace flowdlo::strand
