#include "survey/shards.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <span>
#include <system_error>

#include "files/whole_file.hpp"

namespace flowdlo::survey {

namespace fs = std::filesystem;

fs::path shard_file(const fs::path& folder, const ShardKind& kind, std::uint64_t shard) {
  return folder / fmt::format("{}_{:05}.bin", kind.name, shard);
}

Result<void> write_shard(const fs::path& file, const ShardKind& kind,
                         const std::vector<Bytes>& samples) {
  std::vector<std::uint64_t> sizes;
  for (const Bytes& sample : samples) sizes.push_back(sample.size());
  Packer head;
  head.put(kind.magic);
  head.put_all(sizes);
  std::vector<std::span<const std::uint8_t>> parts{head.bytes};
  for (const Bytes& sample : samples) parts.emplace_back(sample);
  return files::write_file(file, parts, Durability::kUnsynced);
}

Result<void> make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) return {};
  return Error{ErrorCode::kIo, fmt::format("{}: expected a folder that can be made, got \"{}\"",
                                           folder.string(), failed.message())};
}

Error damaged(const fs::path& file, const ShardKind& kind) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected {} as {} writes them; remove the file and make it again",
                      file.string(), kind.name, kind.maker)};
}

Result<ShardStore> ShardStore::open(const fs::path& folder, const ShardKind& kind) {
  ShardStore store;
  for (std::uint64_t shard = 0; fs::exists(shard_file(folder, kind, shard)); ++shard) {
    const auto file = shard_file(folder, kind, shard);
    std::ifstream stream(file, std::ios::binary);
    std::array<std::uint64_t, 2> head{};
    stream.read(reinterpret_cast<char*>(head.data()), sizeof(head));
    constexpr std::uint64_t kMost = 1000000;
    if (!stream || head[0] != kind.magic || head[1] > kMost) return damaged(file, kind);
    std::vector<std::uint64_t> sizes(head[1]);
    const auto bytes = sizes.size() * sizeof(std::uint64_t);
    stream.read(reinterpret_cast<char*>(sizes.data()), static_cast<std::streamsize>(bytes));
    if (!stream) return damaged(file, kind);
    std::uint64_t offset = sizeof(head) + bytes;
    for (const std::uint64_t size : sizes) {
      store.places_.push_back({store.files_.size(), offset, size});
      offset += size;
    }
    if (offset != fs::file_size(file)) return damaged(file, kind);
    store.files_.push_back(file);
  }
  if (!store.places_.empty()) return store;
  return Error{ErrorCode::kBadInput, fmt::format("{}: expected {}, got none; make some with {}",
                                                 folder.string(), kind.name, kind.maker)};
}

Result<Bytes> ShardStore::read(std::size_t sample) const {
  const Place& place = places_[sample];
  std::ifstream stream(file_of(sample), std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(place.offset));
  Bytes bytes(place.bytes);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (stream) return bytes;
  return Error{ErrorCode::kIo,
               fmt::format("{}: expected a readable file", file_of(sample).string())};
}

}  // namespace flowdlo::survey
