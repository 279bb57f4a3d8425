#include "picture_file.hpp"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "files/regular_file.hpp"
#include "files/shown_name.hpp"
#include "mat/mat_png.hpp"

namespace flowdlo::tools {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;

}  // namespace

Result<FrameFolder> load_picture(const std::filesystem::path& file) {
  const auto bytes = files::read_file(file, kMostBytes);
  if (!bytes) return bytes.error();
  const auto image = mat::decode_png(bytes->view(), files::shown(file));
  if (!image) return image.error();
  if (image->depth() != CV_8U) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("{}: expected an 8-bit colour image, got 16 bits; is it a depth image?",
                    files::shown(file))};
  }
  cv::Mat color = *image;
  if (color.channels() != 3) {
    cv::cvtColor(color, color, color.channels() == 4 ? cv::COLOR_BGRA2BGR : cv::COLOR_GRAY2BGR);
  }
  FrameFolder picture;
  picture.name = file.stem().string();
  picture.width = color.cols;
  picture.height = color.rows;
  picture.color_bgr.assign(color.datastart, color.datastart + color.total() * color.elemSize());
  picture.mask.assign(color.total(), 0);
  return picture;
}

}  // namespace flowdlo::tools
