#include "recording/bag_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "frame/temporary_folder.hpp"
#include "recording/drawn_recording.hpp"
#include "support/peak_memory.hpp"

namespace flowdlo::recording {
namespace {

namespace fs = std::filesystem;
using namespace flowdlo::test;
using testing::HasSubstr;

constexpr std::uint32_t kArray = 0x10000000;             // 2 GiB of doubles
constexpr std::uint32_t kOverflowingArray = 0x20000000;  // 2^32 bytes of doubles: 0 in 32 bits

/// A message field by field, as ROS lays it out.
class RawMessage {
 public:
  RawMessage() { numbers<std::uint32_t>({7, 1600000000, 5}).text("camera"); }  // std_msgs/Header

  template <class Number>
  RawMessage& numbers(const std::vector<Number>& values) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(Number));
    return *this;
  }

  RawMessage& text(const std::string& words) {
    numbers<std::uint32_t>({static_cast<std::uint32_t>(words.size())});
    bytes.insert(bytes.end(), words.begin(), words.end());
    return *this;
  }

  std::vector<std::uint8_t> bytes;
};

std::vector<std::uint8_t> image_bytes(std::uint32_t announced) {
  return RawMessage()
      .numbers<std::uint32_t>({1, 3})
      .text("mono8")
      .numbers<std::uint8_t>({0})
      .numbers<std::uint32_t>({3, announced})
      .numbers<std::uint8_t>({10, 20, 30})
      .bytes;
}

std::vector<std::uint8_t> compressed_bytes(std::uint32_t announced) {
  return RawMessage()
      .text("png")
      .numbers<std::uint32_t>({announced})
      .numbers<std::uint8_t>({10, 20, 30})
      .bytes;
}

std::vector<std::uint8_t> camera_bytes(std::uint32_t announced) {
  std::vector<double> matrices(9 + 9 + 12);
  for (std::size_t i = 0; i < matrices.size(); ++i) matrices[i] = static_cast<double>(i);
  return RawMessage()
      .numbers<std::uint32_t>({6, 8})
      .text("plumb_bob")
      .numbers<std::uint32_t>({announced})
      .numbers<double>({0.5, 0.25})
      .numbers(matrices)
      .numbers<std::uint32_t>({1, 1, 0, 0, 6, 8})
      .numbers<std::uint8_t>({0})
      .bytes;
}

TEST(BagMessage, ImageIsReadFieldByField) {
  const auto image = parse_image(image_bytes(3), "m");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_FALSE(image->compressed);
  EXPECT_EQ(image->height, 1U);
  EXPECT_EQ(image->width, 3U);
  EXPECT_EQ(image->encoding, "mono8");
  EXPECT_EQ(image->step, 3U);
  EXPECT_EQ(image->data, (std::vector<std::uint8_t>{10, 20, 30}));
}

TEST(BagMessage, CompressedImageIsReadFieldByField) {
  const auto image = parse_compressed_image(compressed_bytes(3), "m");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_TRUE(image->compressed);
  EXPECT_EQ(image->format, "png");
  EXPECT_EQ(image->data, (std::vector<std::uint8_t>{10, 20, 30}));
}

TEST(BagMessage, CameraIsReadFieldByField) {
  const auto camera = parse_camera_info(camera_bytes(2), "m");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->height, 6U);
  EXPECT_EQ(camera->width, 8U);
  EXPECT_EQ(camera->model, "plumb_bob");
  EXPECT_EQ(camera->d, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(camera->k[8], 8.0);
  EXPECT_EQ(camera->p[0], 18.0);
  EXPECT_EQ(camera->p[11], 29.0);
  EXPECT_FALSE(camera->cropped) << "the region is the whole image";
}

TEST(BagMessage, CutShortAnywhereIsRefused) {
  const auto cut_everywhere = [](const std::vector<std::uint8_t>& whole, const auto& parse) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto end = whole.begin() + static_cast<std::ptrdiff_t>(size);
      const auto message = parse(std::vector<std::uint8_t>(whole.begin(), end), "m");
      ASSERT_FALSE(message) << size << " of " << whole.size() << " bytes";
      EXPECT_THAT(message.error().message, HasSubstr("m: expected a whole sensor_msgs/"));
    }
  };
  cut_everywhere(image_bytes(3), parse_image);
  cut_everywhere(compressed_bytes(3), parse_compressed_image);
  cut_everywhere(camera_bytes(2), parse_camera_info);
}

TEST(BagMessage, LengthsBeyondTheMessageTakeNoMemory) {
  const double grown_mb = peak_growth_mb([] {
    for (const std::uint32_t announced : {4U, kArray, kOverflowingArray, 0xFFFFFFFFU}) {
      EXPECT_FALSE(parse_image(image_bytes(announced), "m")) << announced;
      EXPECT_FALSE(parse_compressed_image(compressed_bytes(announced), "m")) << announced;
      EXPECT_FALSE(parse_camera_info(camera_bytes(announced), "m")) << announced;
    }
  });
  EXPECT_LT(grown_mb, 5);
}

// What is changed is the length of the lens' coefficients, which stands behind its name.
TEST(BagMessage, BagThatAnnouncesAnArrayTakesNoMemoryForIt) {
  const TemporaryFolder scratch;
  const fs::path file = scratch.path() / "small.bag";
  {
    BagWriter bag(file, Packing::kPlain);
    CameraMessage camera;
    camera.model = "lens of a test";
    camera.d = {0.5};
    bag.camera("/info", kStart_ns, camera);
  }
  std::string bytes = read_text(file);
  const auto length = bytes.find("lens of a test") + std::strlen("lens of a test");
  for (const std::uint32_t announced : {kArray, kOverflowingArray}) {
    std::memcpy(bytes.data() + length, &announced, sizeof(announced));
    write_text(file, bytes);
    const double grown_mb = peak_growth_mb([&] {
      const auto bag = Bag::open(file);
      ASSERT_TRUE(bag) << bag.error().message;
      const auto camera = bag->camera("/info", 0);
      ASSERT_FALSE(camera);
      EXPECT_THAT(camera.error().message, HasSubstr("message 0 of /info"));
    });
    EXPECT_LT(grown_mb, 50) << "a file of " << bytes.size() << " bytes";
  }
}

}  // namespace
}  // namespace flowdlo::recording
