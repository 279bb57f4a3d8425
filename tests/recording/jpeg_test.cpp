#include "recording/jpeg.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <vector>

#include "jpeg_error_jump.hpp"

namespace flowdlo::recording {
namespace {

constexpr int kSide_px = 64;

/// A grey image whose frequencies come in `bands` passes, beside the first one of its mean values.
std::vector<std::uint8_t> progressive_jpeg(int bands) {
  std::vector<jpeg_scan_info> scans{{1, {0, 0, 0, 0}, 0, 0, 0, 0}};
  for (int band = 1; band <= bands; ++band) {
    const int last = band == bands ? 63 : band;
    scans.push_back({1, {0, 0, 0, 0}, band, last, 0, 0});
  }
  jpeg_compress_struct state{};
  jpeg_error_mgr errors{};
  state.err = jpeg_std_error(&errors);
  jpeg_create_compress(&state);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&state, &memory, &size);
  state.image_width = kSide_px;
  state.image_height = kSide_px;
  state.input_components = 1;
  state.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&state);
  state.scan_info = scans.data();
  state.num_scans = static_cast<int>(scans.size());
  jpeg_start_compress(&state, TRUE);
  std::vector<unsigned char> row(kSide_px);
  while (state.next_scanline < state.image_height) {
    for (int u = 0; u < kSide_px; ++u) row[u] = static_cast<unsigned char>(3 * u);
    JSAMPROW rows = row.data();
    jpeg_write_scanlines(&state, &rows, 1);
  }
  jpeg_finish_compress(&state);
  std::vector<std::uint8_t> bytes(memory, memory + size);
  jpeg_destroy_compress(&state);
  std::free(memory);
  return bytes;
}

TEST(Jpeg, ProgressiveImageIsRead) {
  const auto image = decode_grey_jpeg(progressive_jpeg(8), kSide_px);
  ASSERT_EQ(image.size(), (image::Size{kSide_px, kSide_px}));
  EXPECT_NEAR(image.at(10, 20), 60, 4);
}

TEST(Jpeg, GreyImageIsAColouredOneOfEqualChannels) {
  const auto grey = decode_grey_jpeg(progressive_jpeg(8), kSide_px);
  const auto picture = decode_jpeg(progressive_jpeg(8), kSide_px);
  ASSERT_EQ(picture.size(), grey.size());
  EXPECT_EQ(picture.at(10, 20), support::color_of(grey.at(10, 20)));
}

// Each pass goes over the whole image: 64 kB of them would take minutes.
TEST(Jpeg, MorePassesThanAnyEncoderWritesAreRefused) {
  EXPECT_TRUE(decode_grey_jpeg(progressive_jpeg(63), kSide_px).empty());
}

TEST(Jpeg, SideBeyondTheLimitIsRefused) {
  EXPECT_TRUE(decode_grey_jpeg(progressive_jpeg(8), kSide_px - 1).empty());
}

}  // namespace
}  // namespace flowdlo::recording
