#include "recording/bag.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "frame/temporary_folder.hpp"
#include "recording/drawn_recording.hpp"
#include "support/peak_memory.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::recording {
namespace {

namespace fs = std::filesystem;
using namespace flowdlo::test;
using testing::HasSubstr;

class BagTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path file() const { return scratch_.path() / "small.bag"; }

  // Four small images and their camera, in chunks of `packing`.
  std::string write(Packing packing) {
    {
      BagWriter bag(file(), packing);
      const cv::Mat image(40, 50, CV_8UC3, cv::Scalar(1, 2, 3));
      for (int i = 0; i < 40; ++i) {
        const Stamp at = kStart_ns + i * kMillisecond_ns;
        bag.image("/image", at, raw_message(image, "bgr8"));
        CameraMessage camera;
        camera.model = "plumb_bob";
        bag.camera("/info", at, camera);
      }
    }
    return read_text(file());
  }

  std::string refusal() {
    const auto bag = Bag::open(file());
    return bag ? "" : bag.error().message;
  }

  TemporaryFolder scratch_;
};

TEST_F(BagTest, ListsItsTopics) {
  write(Packing::kPlain);
  const auto bag = Bag::open(file());
  ASSERT_TRUE(bag) << bag.error().message;
  ASSERT_EQ(bag->topics().size(), 2U);
  EXPECT_EQ(bag->topics()[0].name, "/image");
  EXPECT_EQ(bag->topics()[0].type, "sensor_msgs/Image");
  EXPECT_EQ(bag->topics()[0].messages, 40U);
}

TEST_F(BagTest, StampsAreThoseOfTheHeaders) {
  write(Packing::kLz4);
  const auto bag = Bag::open(file());
  ASSERT_TRUE(bag);
  std::size_t read = 0;
  const auto stamps = bag->stamps({"/image", "/info"}, [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(done, ++read);
    EXPECT_EQ(total, 80U);
  });
  ASSERT_TRUE(stamps);
  EXPECT_EQ(read, 80U);
  const auto& images = stamps->at("/image");
  ASSERT_EQ(images.size(), 40U);
  EXPECT_EQ(images.front(), kStart_ns);
  EXPECT_EQ(images.back(), kStart_ns + 39 * kMillisecond_ns);
}

TEST_F(BagTest, MessageOfAnotherTypeIsRefused) {
  write(Packing::kPlain);
  const auto bag = Bag::open(file());
  ASSERT_TRUE(bag);
  const auto camera = bag->camera("/image", 0);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error().message, HasSubstr("not a sensor_msgs/CameraInfo"));
  EXPECT_FALSE(bag->image("/info", 0));
  EXPECT_FALSE(bag->image("/image", 40));
  EXPECT_FALSE(bag->image("/nothing", 0));
}

TEST_F(BagTest, FileThatIsNoBagIsRefused) {
  EXPECT_THAT(refusal(), HasSubstr("expected a file, found none"));
  for (const char* text : {"", "hello", "#ROSBAG V1.2\n", "#ROSBAG V2.0\n"}) {
    write_text(file(), text);
    EXPECT_THAT(refusal(), HasSubstr("expected a")) << text;
  }
}

TEST_F(BagTest, CutOffBagIsToldFromOneThatWasNeverClosed) {
  const std::string whole = write(Packing::kPlain);
  for (const std::size_t kept : {std::size_t{4000}, whole.size() / 2, whole.size() - 5}) {
    write_text(file(), whole.substr(0, kept));
    EXPECT_THAT(refusal(), HasSubstr("(cut off?)")) << kept;
  }
  std::string open = whole;
  const auto field = open.find("index_pos=");
  ASSERT_NE(field, std::string::npos);
  open.replace(field + 10, 8, std::string(8, '\0'));
  write_text(file(), open);
  EXPECT_THAT(refusal(), HasSubstr("its recording was not closed; `rosbag reindex`"));
}

TEST_F(BagTest, AnIndexThatPointsBesideAMessageIsRefused) {
  for (const Packing packing : {Packing::kPlain, Packing::kBz2, Packing::kLz4}) {
    std::string bag = write(packing);
    const std::size_t op = bag.find("op=\x04");
    ASSERT_NE(op, std::string::npos);
    // Behind it the field "ver", the length of the entries, and the time of the first one.
    const std::size_t offset = op + 4 + (4 + 4 + 4) + 4 + 8;
    bag[offset] = static_cast<char>(bag[offset] + 1);
    write_text(file(), bag);
    EXPECT_NE(refusal().find("is damaged"), std::string::npos) << refusal();
  }
}

TEST_F(BagTest, AConnectionWhoseFieldsRunOverItsEndIsRefused) {
  std::string bag = write(Packing::kPlain);
  const std::size_t field = bag.rfind("message_definition=");
  ASSERT_NE(field, std::string::npos);
  std::uint32_t length = 0;
  std::memcpy(&length, bag.data() + field - sizeof(length), sizeof(length));
  length += 200;
  std::memcpy(bag.data() + field - sizeof(length), &length, sizeof(length));
  write_text(file(), bag);
  EXPECT_THAT(refusal(), HasSubstr("has a damaged header"));
}

TEST_F(BagTest, AChunkThatAnnouncesMoreThanItHoldsTakesNoMemoryForIt) {
  constexpr std::uint32_t kAnnounced = 1U << 28U;
  for (const Packing packing : {Packing::kBz2, Packing::kLz4}) {
    std::string bag = write(packing);
    const std::size_t size = bag.find("size=", bag.find("compression="));
    ASSERT_NE(size, std::string::npos);
    std::memcpy(bag.data() + size + std::strlen("size="), &kAnnounced, sizeof(kAnnounced));
    write_text(file(), bag);
    const double grown_mb = peak_growth_mb([&] { EXPECT_FALSE(refusal().empty()); });
    EXPECT_LT(grown_mb, 50) << "a file of " << bag.size() << " bytes";
  }
}

constexpr int kDamagedBags = 450;

TEST_F(BagTest, DamageNeverEndsTheProcess) {
  std::mt19937 dice(20261121);
  for (const Packing packing : {Packing::kPlain, Packing::kBz2, Packing::kLz4}) {
    const std::string whole = write(packing);
    for (int trial = 0; trial < kDamagedBags / 3; ++trial) {
      std::string damaged = whole;
      for (int i = 0; i < 1 + trial % 4;
           ++i) {  // mostly where lengths, offsets and the index stand
        const std::size_t tail = std::min<std::size_t>(whole.size(), 3000);
        const std::size_t range = trial % 3 == 0 ? whole.size() : tail;
        damaged[whole.size() - 1 - dice() % range] = static_cast<char>(dice());
      }
      write_text(file(), damaged);
      const auto bag = Bag::open(file());
      if (!bag) continue;
      for (const Topic& topic : bag->topics()) {
        (void)static_cast<bool>(bag->stamps({topic.name}, {}));
        for (std::size_t i = 0; i < topic.messages; ++i) {
          (void)static_cast<bool>(bag->image(topic.name, i));
          (void)static_cast<bool>(bag->camera(topic.name, i));
        }
      }
    }
  }
}

TEST(Recordings, DocumentSaysHowManyBagsAreDamaged) {
  const std::string words = std::to_string(kDamagedBags) + " bags with random damage";
  std::string document = read_text(test::source_dir() / "docs/recordings.md");
  std::replace(document.begin(), document.end(), '\n', ' ');
  EXPECT_THAT(document, HasSubstr(words));
}

}  // namespace
}  // namespace flowdlo::recording
