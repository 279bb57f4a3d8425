#include "frame/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <optional>

#include "frame/limits.hpp"

namespace flowdlo::frame {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkFrame = 12;  // length, type and checksum, four bytes each

std::uint32_t big_endian(Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t value = n;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1) ? 0xEDB88320U ^ value >> 1 : value >> 1;
    table[n] = value;
  }
  return table;
}

// CRC-32 as PNG has it (ISO 3309).
std::uint32_t crc(Bytes bytes) {
  static constexpr auto kTable = crc_table();
  std::uint32_t value = 0xFFFFFFFFU;
  for (const auto byte : bytes) value = kTable[(value ^ byte) & 0xFF] ^ value >> 8;
  return value ^ 0xFFFFFFFFU;
}

struct Size {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// A hostile header asks for gigabytes, and libpng reads on over damage that a frame should not
// survive. So the file's frame (sizes, chunks, checksums, end mark) is verified here. An empty
// string: whole.
std::string damage(Bytes bytes, Size& size) {
  if (bytes.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) {
    return "expected a PNG image, got another kind of file";
  }
  bool has_header = false;
  bool has_pixels = false;
  for (std::size_t at = kSignature.size(); at < bytes.size();) {
    if (bytes.size() - at < kChunkFrame) return "the PNG is cut short";
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - kChunkFrame) return "the PNG is cut short";
    const auto type = big_endian(bytes, at + 4);
    if (crc(bytes.subspan(at + 4, length + 4)) != big_endian(bytes, at + 8 + length)) {
      return "the PNG is damaged: a checksum does not fit";
    }
    if (!has_header) {
      if (type != 0x49484452U || length != 13) return "the PNG is damaged: it has no header";
      size = {big_endian(bytes, at + 8), big_endian(bytes, at + 12)};
      has_header = true;
    }
    has_pixels = has_pixels || type == 0x49444154U;                             // IDAT
    if (type == 0x49454E44U) return has_pixels ? "" : "the PNG has no pixels";  // IEND
    at += length + kChunkFrame;
  }
  return "the PNG is cut short";
}

/// libpng's memory, so that what it lacked is told from what is damaged: to its callers both are
/// the same jump. png_get_mem_ptr gives where to say so.
void* take_memory(png_structp png, png_alloc_size_t bytes) {
  void* const memory = std::malloc(bytes);
  if (memory == nullptr) *static_cast<bool*>(png_get_mem_ptr(png)) = true;
  return memory;
}
void give_back(png_structp, png_voidp memory) { std::free(memory); }

Error no_memory(const std::string& who) {
  return {ErrorCode::kOutOfMemory,
          who + ": expected memory for a PNG, got none; free some and try again"};
}

[[noreturn]] void jump(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore(png_structp, png_const_charp) {}

/// libpng jumps out of whatever fails: between setjmp and libpng's return nothing may be alive that
/// has a destructor. Hence small steps that say whether they came through.
class Decoder {
 public:
  explicit Decoder(Bytes bytes)
      : rest_(bytes),
        png_(png_create_read_struct_2(PNG_LIBPNG_VER_STRING, nullptr, jump, ignore, &lacked_,
                                      take_memory, give_back)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Everything as 1, 3 or 4 channels of 8 or 16 bits, in this machine's byte order.
  [[nodiscard]] bool read_header() {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, read);
    // Text, profiles and the like are skipped, not unpacked: a file of 2 MB may hold gigabytes of
    // them, and no pixel depends on any. -1 stands for all of them that libpng knows.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png_, info_);
    const bool grey = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY;
    png_set_palette_to_rgb(png_);
    if (grey) {
      png_set_expand_gray_1_2_4_to_8(png_);
      png_set_strip_alpha(png_);  // one value may be declared transparent: it stays a value
    } else {
      png_set_gray_to_rgb(png_);
      png_set_tRNS_to_alpha(png_);
      png_set_bgr(png_);
    }
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  [[nodiscard]] PngFormat format(const Size& size) const {
    return {static_cast<int>(size.width), static_cast<int>(size.height),
            png_get_channels(png_, info_), png_get_bit_depth(png_, info_) == 16 ? 16 : 8};
  }

  [[nodiscard]] bool read_pixels(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] bool lacked_memory() const { return lacked_; }

 private:
  static void read(png_structp png, png_bytep target, std::size_t size) {
    Bytes& rest = static_cast<Decoder*>(png_get_io_ptr(png))->rest_;
    if (size > rest.size()) png_error(png, "cut short");
    std::copy_n(rest.begin(), size, target);
    rest = rest.subspan(size);
  }

  Bytes rest_;
  bool lacked_ = false;
  png_structp png_;
  png_infop info_;
};

/// As above; `bytes` receives the file.
class Encoder {
 public:
  explicit Encoder(std::vector<std::uint8_t>& bytes)
      : bytes_(bytes),
        png_(png_create_write_struct_2(PNG_LIBPNG_VER_STRING, nullptr, jump, ignore, &lacked_,
                                       take_memory, give_back)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {}
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png_, &info_); }

  /// Fast rather than small.
  [[nodiscard]] bool write(png_uint_32 width, png_uint_32 height, int bits, int color_type,
                           png_bytepp rows) {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_write_fn(png_, this, append, nullptr);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, 1);
    png_set_IHDR(png_, info_, width, height, bits, color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    png_set_bgr(png_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_write_image(png_, rows);
    png_write_end(png_, info_);
    return true;
  }

  [[nodiscard]] bool lacked_memory() const { return lacked_; }

 private:
  static void append(png_structp png, png_bytep source, std::size_t size) {
    if (!static_cast<Encoder*>(png_get_io_ptr(png))->take(source, size))
      png_error(png, "no memory");
  }

  [[nodiscard]] bool take(const std::uint8_t* source, std::size_t size) {
    try {
      bytes_.insert(bytes_.end(), source, source + size);
      return true;
    } catch (const std::bad_alloc&) {
      lacked_ = true;
      return false;
    }
  }

  std::vector<std::uint8_t>& bytes_;
  bool lacked_ = false;
  png_structp png_;
  png_infop info_;
};

std::vector<png_bytep> rows_of(png_bytep first, int count, std::size_t stride_bytes) {
  std::vector<png_bytep> rows;
  for (int v = 0; v < count; ++v) {
    rows.push_back(first + static_cast<std::size_t>(v) * stride_bytes);
  }
  return rows;
}

/// What PNG calls the channels of an image; none where it has no such kind.
std::optional<int> color_type_of(const PngFormat& format) {
  if (format.width < 1 || format.height < 1) return std::nullopt;
  if (format.bits != 8 && format.bits != 16) return std::nullopt;
  switch (format.channels) {
    case 1:
      return PNG_COLOR_TYPE_GRAY;
    case 3:
      return PNG_COLOR_TYPE_RGB;
    case 4:
      return PNG_COLOR_TYPE_RGB_ALPHA;
    default:
      return std::nullopt;
  }
}

}  // namespace

Result<PngImage> decode_png(Bytes bytes, const std::string& who) {
  Size size;
  const auto fault = damage(bytes, size);
  if (!fault.empty()) return Error{ErrorCode::kBadInput, who + ": " + fault + "; write it again"};
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide_px || size.height > kMaxSide_px) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected sides of 1 to {} px, got {} x {}; scale the images", who,
                             kMaxSide_px, size.width, size.height)};
  }
  Decoder decoder(bytes);
  if (decoder.read_header()) {
    PngImage image(decoder.format(size));
    const auto values = image.values<png_byte>();
    const std::size_t bytes_a_row = values.size() / size.height * image.format().bits / 8;
    auto rows = rows_of(values.data(), image.format().height, bytes_a_row);
    if (decoder.read_pixels(rows.data())) return image;
  }
  if (decoder.lacked_memory()) return no_memory(who);
  return Error{ErrorCode::kBadInput, who + ": the PNG is damaged; write it again"};
}

Result<std::vector<std::uint8_t>> encode_png(const PngFormat& format, const void* first,
                                             std::size_t stride_bytes) {
  const auto color_type = color_type_of(format);
  if (!color_type || first == nullptr) {
    return Error{ErrorCode::kInternal,
                 "encode_png: expected 8 or 16 bits and 1, 3 or 4 channels, got another image"};
  }
  std::vector<std::uint8_t> bytes;
  // libpng takes rows that it could change, and only reads them.
  auto* const pixels = const_cast<png_bytep>(static_cast<png_const_bytep>(first));
  auto rows = rows_of(pixels, format.height, stride_bytes);
  Encoder encoder(bytes);
  if (encoder.write(static_cast<png_uint_32>(format.width), static_cast<png_uint_32>(format.height),
                    format.bits, *color_type, rows.data())) {
    return bytes;
  }
  if (encoder.lacked_memory()) return no_memory("encode_png");
  return Error{ErrorCode::kInternal, "encode_png: libpng could not encode the image"};
}

}  // namespace flowdlo::frame
