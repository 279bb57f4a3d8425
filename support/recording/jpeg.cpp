#include "recording/jpeg.hpp"

#include <cstddef>
#include <utility>

#include "jpeg_error_jump.hpp"
// after jpeglib.h
#include <jerror.h>

namespace flowdlo::recording {
namespace {

// A progressive file of 64 kB may announce thousands of passes over 4096 x 4096 px; libjpeg writes
// 10 of them.
constexpr int kMostScans = 32;

/// Called between rows.
void count_scans(j_common_ptr state) {
  const auto* decoder = reinterpret_cast<j_decompress_ptr>(state);
  if (decoder->input_scan_number > kMostScans) support::JpegErrorJump::jump(state);
}

/// A file that is cut short comes as a warning, and is an error here; what cameras get wrong
/// otherwise is read over.
void judge(j_common_ptr state, int level) {
  if (level < 0 && state->err->msg_code == JWRN_JPEG_EOF) support::JpegErrorJump::jump(state);
}

struct Decoder {
  jpeg_decompress_struct state{};
  support::JpegErrorJump handler{};
  jpeg_progress_mgr progress{};

  Decoder() {
    handler.attach(state);
    handler.base.emit_message = judge;
    progress.progress_monitor = count_scans;
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { jpeg_destroy_decompress(&state); }

  bool read_header(std::span<const std::uint8_t> bytes) {
    if (setjmp(handler.back) != 0) return false;
    jpeg_create_decompress(&state);
    state.progress = &progress;
    jpeg_mem_src(&state, bytes.data(), bytes.size());
    return jpeg_read_header(&state, TRUE) == JPEG_HEADER_OK;
  }

  bool read_pixels(std::uint8_t* first, std::ptrdiff_t stride_bytes, J_COLOR_SPACE colors) {
    if (setjmp(handler.back) != 0) return false;
    state.out_color_space = colors;
    jpeg_start_decompress(&state);
    while (state.output_scanline < state.output_height) {
      JSAMPROW row = first + state.output_scanline * stride_bytes;
      jpeg_read_scanlines(&state, &row, 1);
    }
    jpeg_finish_decompress(&state);
    return true;
  }
};

template <class Pixel>
image::Image<Pixel> decoded(std::span<const std::uint8_t> bytes, int most_px,
                            J_COLOR_SPACE colors) {
  Decoder decoder;
  if (bytes.empty() || !decoder.read_header(bytes)) return {};
  const auto most = static_cast<JDIMENSION>(most_px);
  if (decoder.state.image_width > most || decoder.state.image_height > most) return {};
  image::Image<Pixel> image(
      {static_cast<int>(decoder.state.image_width), static_cast<int>(decoder.state.image_height)});
  auto* const first = reinterpret_cast<std::uint8_t*>(image.data());
  const auto stride_bytes = image.stride() * static_cast<std::ptrdiff_t>(sizeof(Pixel));
  if (!decoder.read_pixels(first, stride_bytes, colors)) return {};
  return image;
}

}  // namespace

support::Picture decode_jpeg(std::span<const std::uint8_t> bytes, int most_px) {
  auto picture = decoded<support::Color>(bytes, most_px, JCS_RGB);
  for (std::size_t i = 0; i < picture.total(); ++i) {
    support::Color& color = picture.data()[i];
    std::swap(color[0], color[2]);
  }
  return picture;
}

image::Image<std::uint8_t> decode_grey_jpeg(std::span<const std::uint8_t> bytes, int most_px) {
  return decoded<std::uint8_t>(bytes, most_px, JCS_GRAYSCALE);
}

}  // namespace flowdlo::recording
