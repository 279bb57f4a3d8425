#include "train/record_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <span>

#include "files/regular_file.hpp"
#include "files/whole_file.hpp"
#include "survey/packed.hpp"
#include "weights/sha256.hpp"

namespace flowdlo::train {
namespace {

constexpr char kMagic[8] = {'F', 'D', 'L', 'R', 'E', 'C', '0', '1'};
constexpr std::size_t kDigestBytes = 64;
constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30U;  // of a shard

void put(survey::Packer& to, const Record& record) {
  to.put(record.index);
  to.put_text(record.scenario);
  to.put(record.difficulty);
  to.put(static_cast<std::uint8_t>(record.intersection ? 1 : 0));
  to.put(record.camera);
  to.put(record.mask.width);
  to.put(record.mask.height);
  to.put_all(record.mask.runs);
  to.put(record.visible);
  to.put_all(record.priors);
  to.put_all(record.depth_m);
  to.put(record.truth);
}

Record get_record(survey::Unpacker& from) {
  Record record;
  from.get(record.index);
  record.scenario = from.get_text();
  from.get(record.difficulty);
  record.intersection = from.get<std::uint8_t>() != 0;
  from.get(record.camera);
  from.get(record.mask.width);
  from.get(record.mask.height);
  from.get_all(record.mask.runs);
  from.get(record.visible);
  from.get_all(record.priors);
  from.get_all(record.depth_m);
  from.get(record.truth);
  return record;
}

Error damaged(const std::filesystem::path& file, const std::string& got) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected a shard of training records, got {}; delete it and run "
                      "flowdlo-train records again",
                      file.string(), got)};
}

std::string digest_of(std::span<const std::uint8_t> bytes) {
  weights::Sha256 sha;
  sha.update(bytes);
  return sha.finish();
}

}  // namespace

Result<void> write_shard(Shard& shard, const std::filesystem::path& file) {
  survey::Packer writer;
  writer.put_text(shard.origin);
  writer.put(shard.first);
  writer.put(shard.scenes);
  writer.put(shard.skipped);
  writer.put(static_cast<std::uint32_t>(shard.records.size()));
  for (const Record& record : shard.records) put(writer, record);
  shard.sha256 = digest_of(writer.bytes);

  const auto* magic = reinterpret_cast<const std::uint8_t*>(kMagic);
  const auto* digest = reinterpret_cast<const std::uint8_t*>(shard.sha256.data());
  return files::write_file(
      file, {{magic, sizeof kMagic}, {digest, kDigestBytes}, std::span(writer.bytes)});
}

Result<Shard> read_shard(const std::filesystem::path& file) {
  const auto content = files::read_file(file, kMostBytes);
  if (!content) return content.error();
  const auto bytes = content->view();
  constexpr std::size_t kHead = sizeof kMagic + kDigestBytes;
  if (bytes.size() < kHead || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    return damaged(file, "another kind of file or version");
  }
  const auto payload = bytes.subspan(kHead);
  Shard shard;
  shard.sha256 = digest_of(payload);
  if (std::memcmp(shard.sha256.data(), bytes.data() + sizeof kMagic, kDigestBytes) != 0) {
    return damaged(file, "one whose content does not match its digest");
  }
  survey::Unpacker reader(payload);
  shard.origin = reader.get_text();
  shard.first = reader.get<std::uint64_t>();
  shard.scenes = reader.get<std::uint32_t>();
  shard.skipped = reader.get<std::uint32_t>();
  const auto count = reader.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && reader.fine(); ++i) {
    shard.records.push_back(get_record(reader));
    if (shard.records.back().priors.empty()) return damaged(file, "a record without a prior");
  }
  if (!reader.fine() || !reader.at_end()) return damaged(file, "one that ends too early or late");
  return shard;
}

}  // namespace flowdlo::train
