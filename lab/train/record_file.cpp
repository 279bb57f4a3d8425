#include "train/record_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "files/regular_file.hpp"
#include "files/whole_file.hpp"
#include "weights/sha256.hpp"

namespace flowdlo::train {
namespace {

static_assert(std::endian::native == std::endian::little, "shards are little-endian");

constexpr char kMagic[8] = {'F', 'D', 'L', 'R', 'E', 'C', '0', '1'};
constexpr std::size_t kDigestBytes = 64;
constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30U;  // of a shard

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof(T));
  }
  template <class T>
  void put_all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(static_cast<std::uint64_t>(values.size()));
    put_bytes(values.data(), values.size() * sizeof(T));
  }
  void put_text(const std::string& text) { put_all(std::vector<char>(text.begin(), text.end())); }
  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void put_bytes(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::uint8_t> bytes_;
};

/// Reads past the end set `fine` to false and give zeros.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    T value{};
    take(&value, sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> get_all() {
    const auto count = get<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) {
      fine_ = false;
      return {};
    }
    std::vector<T> values(count);
    take(values.data(), count * sizeof(T));
    return values;
  }
  std::string get_text() {
    const auto letters = get_all<char>();
    return {letters.begin(), letters.end()};
  }
  [[nodiscard]] bool fine() const { return fine_; }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  void take(void* data, std::size_t size) {
    if (size > bytes_.size()) {
      fine_ = false;
      return;
    }
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::span<const std::uint8_t> bytes_;
  bool fine_ = true;
};

void put(Writer& writer, const Record& record) {
  writer.put(record.index);
  writer.put_text(record.scenario);
  writer.put(record.difficulty);
  writer.put(static_cast<std::uint8_t>(record.intersection ? 1 : 0));
  writer.put(record.camera);
  writer.put(record.mask.width);
  writer.put(record.mask.height);
  writer.put_all(record.mask.runs);
  writer.put(record.visible);
  writer.put_all(record.priors);
  writer.put_all(record.depth_m);
  writer.put(record.truth);
}

Record get_record(Reader& reader) {
  Record record;
  record.index = reader.get<std::uint64_t>();
  record.scenario = reader.get_text();
  record.difficulty = reader.get<Difficulty>();
  record.intersection = reader.get<std::uint8_t>() != 0;
  record.camera = reader.get<Intrinsics>();
  record.mask.width = reader.get<int>();
  record.mask.height = reader.get<int>();
  record.mask.runs = reader.get_all<MaskRun>();
  record.visible = reader.get<evidence::VisiblePoints>();
  record.priors = reader.get_all<PriorState>();
  record.depth_m = reader.get_all<float>();
  record.truth = reader.get<Centerline>();
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
  Writer writer;
  writer.put_text(shard.origin);
  writer.put(shard.first);
  writer.put(shard.scenes);
  writer.put(shard.skipped);
  writer.put(static_cast<std::uint32_t>(shard.records.size()));
  for (const Record& record : shard.records) put(writer, record);
  shard.sha256 = digest_of(writer.bytes());

  const auto* magic = reinterpret_cast<const std::uint8_t*>(kMagic);
  const auto* digest = reinterpret_cast<const std::uint8_t*>(shard.sha256.data());
  return files::write_file(
      file, {{magic, sizeof kMagic}, {digest, kDigestBytes}, std::span(writer.bytes())});
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
  Reader reader(payload);
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
