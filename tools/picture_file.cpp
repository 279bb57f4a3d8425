#include "picture_file.hpp"

#include <fmt/format.h>

#include "files/regular_file.hpp"
#include "files/shown_name.hpp"
#include "frame/png.hpp"
#include "png_picture.hpp"

namespace flowdlo::tools {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;

}  // namespace

Result<FrameFolder> load_picture(const std::filesystem::path& file) {
  const auto bytes = files::read_file(file, kMostBytes);
  if (!bytes) return bytes.error();
  const auto png = frame::decode_png(bytes->view(), files::shown(file));
  if (!png) return png.error();
  if (png->format().bits != 8) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("{}: expected an 8-bit colour image, got 16 bits; is it a depth image?",
                    files::shown(file))};
  }
  const auto color = support::picture_of(*png);
  const auto* const first = reinterpret_cast<const std::uint8_t*>(color.data());
  FrameFolder picture;
  picture.name = file.stem().string();
  picture.width = color.width();
  picture.height = color.height();
  picture.color_bgr.assign(first, first + sizeof(support::Color) * color.total());
  picture.mask.assign(color.total(), 0);
  return picture;
}

}  // namespace flowdlo::tools
