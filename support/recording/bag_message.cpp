#include "recording/bag_message.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>

namespace flowdlo::recording {
namespace {

/// The fields of a message, one after another. roscpp's own reader makes room for as many values as
/// a length announces before it looks whether they are there.
class FieldReader {
 public:
  explicit FieldReader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    copy(sizeof(Number), &value);
    return value;
  }

  template <class Number, std::size_t kCount>
  void fill(std::array<Number, kCount>& numbers) {
    copy(kCount * sizeof(Number), numbers.data());
  }

  /// A length, then as many numbers.
  template <class Number>
  std::vector<Number> numbers() {
    const std::size_t count = number<std::uint32_t>();
    if (count > left() / sizeof(Number)) cut_ = true;
    if (cut_) return {};
    std::vector<Number> values(count);
    copy(count * sizeof(Number), values.data());
    return values;
  }

  std::string text() {
    const auto letters = numbers<char>();
    return {letters.begin(), letters.end()};
  }

  /// std_msgs/Header.
  void skip_header() {
    for (int i = 0; i < 3; ++i) number<std::uint32_t>();  // seq, seconds, nanoseconds
    text();
  }

  /// Whether a field ran over the end; whatever was read from there on is empty or 0.
  [[nodiscard]] bool cut() const { return cut_; }

 private:
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  void copy(std::size_t size, void* target) {  // bags are little-endian, as we are
    if (size > left()) cut_ = true;
    if (cut_ || size == 0) return;
    std::memcpy(target, bytes_.data() + at_, size);
    at_ += size;
  }

  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
  bool cut_ = false;
};

Error too_short(const std::string& who, const char* type, std::size_t bytes) {
  return {
      ErrorCode::kBadInput,
      fmt::format("{}: expected a whole {}, got {} bytes, fewer than its lengths say; record it "
                  "again",
                  who, type, bytes)};
}

}  // namespace

Result<ImageMessage> parse_image(const std::vector<std::uint8_t>& bytes, const std::string& who) {
  FieldReader fields(bytes);
  fields.skip_header();
  ImageMessage image;
  image.height = fields.number<std::uint32_t>();
  image.width = fields.number<std::uint32_t>();
  image.encoding = fields.text();
  image.big_endian = fields.number<std::uint8_t>() != 0;
  image.step = fields.number<std::uint32_t>();
  image.data = fields.numbers<std::uint8_t>();
  if (fields.cut()) return too_short(who, "sensor_msgs/Image", bytes.size());
  return image;
}

Result<ImageMessage> parse_compressed_image(const std::vector<std::uint8_t>& bytes,
                                            const std::string& who) {
  FieldReader fields(bytes);
  fields.skip_header();
  ImageMessage image;
  image.compressed = true;
  image.format = fields.text();
  image.data = fields.numbers<std::uint8_t>();
  if (fields.cut()) return too_short(who, "sensor_msgs/CompressedImage", bytes.size());
  return image;
}

Result<CameraMessage> parse_camera_info(const std::vector<std::uint8_t>& bytes,
                                        const std::string& who) {
  FieldReader fields(bytes);
  fields.skip_header();
  CameraMessage camera;
  camera.height = fields.number<std::uint32_t>();
  camera.width = fields.number<std::uint32_t>();
  camera.model = fields.text();
  camera.d = fields.numbers<double>();
  fields.fill(camera.k);
  std::array<double, 9> rotation{};  // of the rectified image, which P holds as well
  fields.fill(rotation);
  fields.fill(camera.p);
  const auto binning_x = fields.number<std::uint32_t>();
  const auto binning_y = fields.number<std::uint32_t>();
  const auto roi_x = fields.number<std::uint32_t>();
  const auto roi_y = fields.number<std::uint32_t>();
  const auto roi_height = fields.number<std::uint32_t>();
  const auto roi_width = fields.number<std::uint32_t>();
  fields.number<std::uint8_t>();  // do_rectify: what the driver means to do with the region
  if (fields.cut()) return too_short(who, "sensor_msgs/CameraInfo", bytes.size());
  const bool whole = roi_width == 0 || (roi_x == 0 && roi_y == 0 && roi_width == camera.width &&
                                        roi_height == camera.height);
  camera.cropped = !whole || binning_x > 1 || binning_y > 1;
  return camera;
}

}  // namespace flowdlo::recording
