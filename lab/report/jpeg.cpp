#include "report/jpeg.hpp"

#include <cstdlib>  // std::free
#include <opencv2/imgproc.hpp>

#include "jpeg_error_jump.hpp"

namespace flowdlo::report {
namespace {

struct Encoder {
  jpeg_compress_struct state{};
  support::JpegErrorJump handler{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT: libjpeg's type

  Encoder() {
    handler.attach(state);
    handler.base.output_message = [](j_common_ptr) {};
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() {
    jpeg_destroy_compress(&state);
    std::free(bytes);
  }

  /// Nothing in here may have a destructor: libjpeg jumps out of it.
  bool write(const cv::Mat& rgb, int quality) {
    if (setjmp(handler.back) != 0) return false;
    jpeg_create_compress(&state);
    jpeg_mem_dest(&state, &bytes, &size);
    state.image_width = static_cast<JDIMENSION>(rgb.cols);
    state.image_height = static_cast<JDIMENSION>(rgb.rows);
    state.input_components = 3;
    state.in_color_space = JCS_RGB;
    jpeg_set_defaults(&state);
    jpeg_set_quality(&state, quality, TRUE);
    jpeg_start_compress(&state, TRUE);
    while (state.next_scanline < state.image_height) {
      auto* row = const_cast<JSAMPROW>(rgb.ptr(static_cast<int>(state.next_scanline)));
      jpeg_write_scanlines(&state, &row, 1);
    }
    jpeg_finish_compress(&state);
    return true;
  }
};

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const cv::Mat& image, int quality) {
  if (image.empty() || image.type() != CV_8UC3) return {};
  cv::Mat rgb;
  cv::cvtColor(image, rgb, cv::COLOR_BGR2RGB);
  Encoder encoder;
  if (!encoder.write(rgb, quality)) return {};
  return {encoder.bytes, encoder.bytes + encoder.size};
}

}  // namespace flowdlo::report
