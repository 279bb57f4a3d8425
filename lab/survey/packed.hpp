// Packed: values one behind another in bytes, as this machine has them.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace flowdlo::survey {

static_assert(std::endian::native == std::endian::little, "files of packed values are so");

using Bytes = std::vector<std::uint8_t>;

class Packer {
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

  Bytes bytes;

 private:
  void put_bytes(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), first, first + size);
  }
};

/// Reads past the end set `fine` to false and give zeros.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(&value, sizeof(T));
  }
  template <class T>
  T get() {
    T value{};
    get(value);
    return value;
  }
  template <class T>
  void get_all(std::vector<T>& values) {
    const auto count = get<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) {
      fine_ = false;
      return;
    }
    values.resize(count);
    take(values.data(), count * sizeof(T));
  }
  std::string get_text() {
    std::vector<char> letters;
    get_all(letters);
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

}  // namespace flowdlo::survey
