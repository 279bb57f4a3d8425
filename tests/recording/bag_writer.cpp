#include "recording/bag_writer.hpp"

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include <algorithm>

namespace flowdlo::test {
namespace {

constexpr recording::Stamp kSecond_ns = 1000000000;
constexpr std::uint32_t kChunkBytes = 100000;

ros::Time time_of(recording::Stamp stamp) {
  return {static_cast<std::uint32_t>(stamp / kSecond_ns),
          static_cast<std::uint32_t>(stamp % kSecond_ns)};
}

rosbag::CompressionType compression_of(Packing packing) {
  switch (packing) {
    case Packing::kBz2:
      return rosbag::compression::BZ2;
    case Packing::kLz4:
      return rosbag::compression::LZ4;
    case Packing::kPlain:
      break;
  }
  return rosbag::compression::Uncompressed;
}

}  // namespace

struct BagWriter::Impl {
  rosbag::Bag bag;
};

BagWriter::BagWriter(const std::filesystem::path& file, Packing packing)
    : impl_(std::make_unique<Impl>()) {
  impl_->bag.open(file.string(), rosbag::bagmode::Write);
  impl_->bag.setCompression(compression_of(packing));
  impl_->bag.setChunkThreshold(kChunkBytes);
}

BagWriter::~BagWriter() { impl_->bag.close(); }

void BagWriter::image(const std::string& topic, recording::Stamp stamp,
                      const recording::ImageMessage& message, recording::Stamp late_ns) {
  const auto arrival = time_of(stamp + late_ns);
  if (message.compressed) {
    sensor_msgs::CompressedImage image;
    image.header.stamp = time_of(stamp);
    image.format = message.format;
    image.data = message.data;
    impl_->bag.write(topic, arrival, image);
    return;
  }
  sensor_msgs::Image image;
  image.header.stamp = time_of(stamp);
  image.width = message.width;
  image.height = message.height;
  image.encoding = message.encoding;
  image.is_bigendian = message.big_endian ? 1 : 0;
  image.step = message.step;
  image.data = message.data;
  impl_->bag.write(topic, arrival, image);
}

void BagWriter::camera(const std::string& topic, recording::Stamp stamp,
                       const recording::CameraMessage& message) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = time_of(stamp);
  info.width = message.width;
  info.height = message.height;
  info.distortion_model = message.model;
  info.D = message.d;
  std::copy(message.k.begin(), message.k.end(), info.K.begin());
  std::copy(message.p.begin(), message.p.end(), info.P.begin());
  info.binning_x = message.cropped ? 2 : 0;
  impl_->bag.write(topic, time_of(stamp + kSecond_ns / 1000), info);
}

void BagWriter::text(const std::string& topic, recording::Stamp stamp, const std::string& words) {
  std_msgs::String message;
  message.data = words;
  impl_->bag.write(topic, time_of(stamp), message);
}

}  // namespace flowdlo::test
