#include "recording/bag_layout.hpp"

#include <fmt/format.h>
#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/regular_size.hpp"

namespace flowdlo::recording {
namespace {

constexpr const char* kVersionLine = "#ROSBAG V2.0\n";
constexpr std::uint64_t kMostHeaderBytes = 1U << 20U;
constexpr std::uint64_t kMostIndexBytes = 1U << 28U;
// Of a compressed one, unpacked. Four images of 4096 x 4096 px; what records bags closes a chunk
// after 768 kB and the message that crosses it.
constexpr std::uint64_t kMostChunkBytes = 1U << 28U;
constexpr std::size_t kIndexEntryBytes = 12;  // time, offset

// Values of the field "op".
constexpr int kMessage = 2;
constexpr int kFileHeader = 3;
constexpr int kIndex = 4;
constexpr int kChunk = 5;
constexpr int kChunkInfo = 6;
constexpr int kConnection = 7;

using Fields = std::map<std::string, std::string>;

template <class Number>
bool read_number(std::string_view bytes, std::size_t at, Number& number) {
  if (at > bytes.size() || bytes.size() - at < sizeof(Number)) return false;
  std::memcpy(&number, bytes.data() + at, sizeof(Number));  // bags are little-endian, as we are
  return true;
}

// A field's number; false when it is missing or has another size.
template <class Number>
bool read_field(const Fields& fields, const char* name, Number& number) {
  const auto found = fields.find(name);
  return found != fields.end() && found->second.size() == sizeof(Number) &&
         read_number(found->second, 0, number);
}

bool parse_fields(const std::string& header, Fields& fields) {
  std::size_t at = 0;
  while (at < header.size()) {
    std::uint32_t length = 0;
    if (!read_number(header, at, length) || length > header.size() - at - sizeof(length)) {
      return false;
    }
    const std::string field = header.substr(at + sizeof(length), length);
    const auto equals = field.find('=');
    if (equals == std::string::npos) return false;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
    at += sizeof(length) + length;
  }
  return true;
}

struct Record {
  std::uint64_t begin = 0;
  std::uint64_t data = 0;  ///< where its data begins
  std::uint64_t end = 0;
  int op = -1;
  Fields fields;
};

// What is wrong, in words; empty: nothing.
using Fault = std::string;

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

class Walker {
 public:
  Walker(std::istream& stream, std::uint64_t size) : stream_(stream), size_(size) {}

  Fault walk() {
    std::uint64_t at = std::strlen(kVersionLine);
    Record record;
    if (auto fault = read_record(at, size_, record); !fault.empty()) return fault;
    if (auto fault = take_file_header(record); !fault.empty()) return fault;
    for (at = record.end; at < size_; at = record.end) {
      if (auto fault = read_record(at, size_, record); !fault.empty()) return fault;
      if (auto fault = take(record); !fault.empty()) return fault;
      starts_index_ = starts_index_ || record.begin == index_begin_;
    }
    if (index_begin_ != size_ && !starts_index_) {
      return fmt::format("no record begins at byte {}, where its index should", index_begin_);
    }
    return {};
  }

 private:
  Fault read_record(std::uint64_t at, std::uint64_t limit, Record& record) {
    record = {};
    record.begin = at;
    std::uint32_t length = 0;
    const Fault cut = fmt::format("the record at byte {} runs over its end (cut off?)", at);
    if (!read_length(at, limit, length) || length > kMostHeaderBytes) return cut;
    std::string header;
    if (!read_bytes(at + sizeof(length), limit, length, header)) return cut;
    std::uint8_t op = 0;
    if (!parse_fields(header, record.fields) || !read_field(record.fields, "op", op)) {
      return fmt::format("the record at byte {} has a damaged header", at);
    }
    record.op = op;
    at += sizeof(length) + length;
    if (!read_length(at, limit, length)) return cut;
    record.data = at + sizeof(length);
    record.end = record.data + length;
    return record.end <= limit ? Fault() : cut;
  }

  Fault take_file_header(const Record& record) {
    if (record.op != kFileHeader || !read_field(record.fields, "index_pos", index_begin_)) {
      return "its first record is no file header";
    }
    const auto encryptor = record.fields.find("encryptor");
    if (encryptor != record.fields.end() && !encryptor->second.empty()) {
      return "it is encrypted; write it again without";
    }
    if (index_begin_ == 0) return "it has no index: its recording was not closed";
    return index_begin_ <= size_ ? Fault() : "its index lies beyond its end (cut off?)";
  }

  Fault take(const Record& record) {
    switch (record.op) {
      case kChunk:
        return take_chunk(record);
      case kIndex:
        return take_index(record);
      case kConnection:
        return take_connection(record);
      case kChunkInfo: {
        std::uint64_t chunk = 0;
        const bool known =
            read_field(record.fields, "chunk_pos", chunk) && chunks_.count(chunk) > 0;
        return known ? Fault()
                     : fmt::format("the record at byte {} names a chunk that is not there",
                                   record.begin);
      }
      default:
        return {};
    }
  }

  // Its data are fields again, and what reads bags follows their lengths wherever they lead.
  Fault take_connection(const Record& record) {
    const std::uint64_t size = record.end - record.data;
    std::string data;
    Fields fields;
    const bool sound = size <= kMostHeaderBytes &&
                       read_bytes(record.data, record.end, size, data) &&
                       parse_fields(data, fields);
    return sound ? Fault()
                 : fmt::format("the connection at byte {} has a damaged header", record.begin);
  }

  Fault take_chunk(const Record& record) {
    const auto compression = record.fields.find("compression");
    if (compression == record.fields.end() || !read_field(record.fields, "size", chunk_size_)) {
      return fmt::format("the chunk at byte {} has a damaged header", record.begin);
    }
    chunks_.insert(record.begin);
    messages_.clear();
    if (compression->second != "none") {
      rosbag::ChunkedFile no_file;
      if (compression->second == "bz2") {
        rosbag::BZ2Stream stream(&no_file);
        return take_packed(record, stream);
      }
      if (compression->second == "lz4") {
        rosbag::LZ4Stream stream(&no_file);
        return take_packed(record, stream);
      }
      return fmt::format("the chunk at byte {} is compressed as \"{}\", expected bz2 or lz4",
                         record.begin, compression->second);
    }
    Record inner;
    for (std::uint64_t at = record.data; at < record.end; at = inner.end) {
      if (auto fault = read_record(at, record.end, inner); !fault.empty()) return fault;
      if (inner.op == kMessage) messages_.insert(at - record.data);
      if (inner.op != kConnection) continue;
      if (auto fault = take_connection(inner); !fault.empty()) return fault;
    }
    return {};
  }

  // What reads bags believes every length inside a compressed chunk.
  Fault take_packed(const Record& record, rosbag::Stream& stream) {
    Fault damaged = fmt::format("the chunk at byte {} cannot be unpacked", record.begin);
    const std::uint64_t size = record.end - record.data;
    std::string packed;
    if (chunk_size_ > kMostChunkBytes || size > kMostChunkBytes ||
        !read_bytes(record.data, record.end, size, packed)) {
      return damaged;
    }
    // By calloc, which leaves zeros to be made when they are written to: what is announced and not
    // there takes no memory, and reads as a record without a header.
    const std::unique_ptr<void, Free> unpacked(std::calloc(std::max(chunk_size_, 1U), 1));
    if (!unpacked) return damaged;
    auto* const bytes = static_cast<std::uint8_t*>(unpacked.get());
    try {
      stream.decompress(bytes, chunk_size_, reinterpret_cast<std::uint8_t*>(packed.data()),
                        static_cast<unsigned int>(size));
    } catch (const std::exception&) {
      return damaged;
    }
    const std::string_view chunk(reinterpret_cast<const char*>(bytes), chunk_size_);
    for (std::size_t at = 0; at < chunk.size();) {
      const std::size_t begin = at;
      std::string_view header;
      std::string_view data;
      Fields fields;
      std::uint8_t op = 0;
      if (!read_part(chunk, at, header) || !parse_fields(std::string(header), fields) ||
          !read_field(fields, "op", op) || !read_part(chunk, at, data) ||
          (op == kConnection && !parse_fields(std::string(data), fields))) {
        return fmt::format("the chunk at byte {} holds a damaged record", record.begin);
      }
      if (op == kMessage) messages_.insert(begin);
    }
    return {};
  }

  // Bytes behind their length; `at` moves on. False when they run over the end.
  static bool read_part(std::string_view bytes, std::size_t& at, std::string_view& part) {
    std::uint32_t length = 0;
    if (!read_number(bytes, at, length)) return false;
    at += sizeof(length);
    if (length > bytes.size() - at) return false;
    part = bytes.substr(at, length);
    at += length;
    return true;
  }

  Fault take_index(const Record& record) {
    const Fault damaged = fmt::format("the index at byte {} is damaged", record.begin);
    std::uint32_t count = 0;
    std::string entries;
    if (chunks_.empty() || !read_field(record.fields, "count", count) ||
        record.end - record.data != count * kIndexEntryBytes ||
        record.end - record.data > kMostIndexBytes ||
        !read_bytes(record.data, record.end, record.end - record.data, entries)) {
      return damaged;
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t offset = 0;
      if (!read_number(entries, i * kIndexEntryBytes + sizeof(std::uint64_t), offset)) {
        return damaged;
      }
      if (messages_.count(offset) == 0) return damaged;
    }
    return {};
  }

  bool read_length(std::uint64_t at, std::uint64_t limit, std::uint32_t& length) {
    std::string bytes;
    return read_bytes(at, limit, sizeof(length), bytes) && read_number(bytes, 0, length);
  }

  bool read_bytes(std::uint64_t at, std::uint64_t limit, std::uint64_t count, std::string& bytes) {
    if (at > limit || limit - at < count) return false;
    bytes.resize(static_cast<std::size_t>(count));
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    return stream_.good();
  }

  std::istream& stream_;
  std::uint64_t size_;
  std::uint64_t index_begin_ = 0;
  bool starts_index_ = false;
  std::set<std::uint64_t> chunks_;    // where they begin
  std::uint32_t chunk_size_ = 0;      // of the last chunk, uncompressed
  std::set<std::uint64_t> messages_;  // of the last chunk: offsets
};

}  // namespace

Result<void> check_bag_layout(std::istream& stream, std::uint64_t size, const std::string& who) {
  std::string line(std::strlen(kVersionLine), '\0');
  stream.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (!stream || line != kVersionLine) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected a ROS 1 bag (\"#ROSBAG V2.0\"), got something else; of "
                             "an older version, make one with `rosbag fix`",
                             who)};
  }
  const Fault fault = Walker(stream, size).walk();
  if (fault.empty()) return {};
  return Error{
      ErrorCode::kBadInput,
      fmt::format("{}: expected a whole bag, but {}; `rosbag reindex` may save it", who, fault)};
}

Result<void> check_bag_layout(const std::filesystem::path& file) {
  const auto size = files::regular_size(file);  // a pipe would be waited for
  if (!size) return size.error();
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    return Error{ErrorCode::kIo, file.string() + ": cannot be read; check path and permissions"};
  }
  return check_bag_layout(stream, *size, file.string());
}

}  // namespace flowdlo::recording
