#include "recording/bag.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <map>
#include <utility>

#include "recording/bag_layout.hpp"

namespace flowdlo::recording {
namespace {

constexpr Stamp kSecond_ns = 1000000000;
constexpr std::size_t kHeaderBytes = 12;  // of std_msgs/Header up to its stamp: seq, sec, nsec

Stamp nanoseconds(const ros::Time& time) { return kSecond_ns * time.sec + time.nsec; }

// What rosbag writes a message into.
struct ByteStream {
  std::vector<std::uint8_t> bytes;
  std::uint8_t* advance(std::uint32_t length) {
    bytes.resize(length);
    return bytes.data();
  }
};

Error bad(const std::filesystem::path& file, const std::string& what) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: cannot be read ({}); check the file with `rosbag check`", file.string(),
                      what)};
}

/// The message as it lies in the bag.
std::vector<std::uint8_t> bytes_of(const rosbag::MessageInstance& message) {
  ByteStream stream;
  message.write(stream);
  return std::move(stream.bytes);
}

}  // namespace

struct Bag::Impl {
  std::filesystem::path path;
  rosbag::Bag bag;
  std::vector<Topic> topics;
  std::map<std::string, std::vector<rosbag::MessageInstance>> messages;

  void read_index() {
    rosbag::View view(bag);
    std::map<std::string, std::string> types;
    for (const auto* connection : view.getConnections()) {
      types[connection->topic] = connection->datatype;
    }
    for (const auto& message : view) messages[message.getTopic()].push_back(message);
    for (const auto& [name, type] : types) topics.push_back({name, type, messages[name].size()});
  }

  [[nodiscard]] std::string who(const std::string& topic, std::size_t index) const {
    return fmt::format("{}: message {} of {}", path.string(), index, topic);
  }

  /// Calls `use` with the message; whatever is thrown on the way becomes an error.
  template <class Use>
  auto read(const std::string& topic, std::size_t index, const Use& use) const
      -> decltype(use(std::declval<const rosbag::MessageInstance&>())) {
    const auto found = messages.find(topic);
    if (found == messages.end() || index >= found->second.size()) {
      return bad(path, fmt::format("{} has no message {}", topic, index));
    }
    try {
      return use(found->second[index]);
    } catch (const std::exception& fault) {
      return bad(path, fmt::format("message {} of {}: {}", index, topic, fault.what()));
    }
  }

  [[nodiscard]] Result<Stamp> stamp(const std::string& topic, std::size_t index,
                                    ByteStream& stream) const {
    return read(topic, index, [&](const rosbag::MessageInstance& message) -> Result<Stamp> {
      message.write(stream);
      if (stream.bytes.size() < kHeaderBytes) return bad(path, topic + " has no header");
      std::array<std::uint32_t, 3> header{};  // bags are little-endian, as we are
      std::memcpy(header.data(), stream.bytes.data(), kHeaderBytes);
      const Stamp own = kSecond_ns * header[1] + header[2];
      return own != 0 ? own : nanoseconds(message.getTime());
    });
  }
};

Result<Bag> Bag::open(const std::filesystem::path& file) {
  // rosbag believes what a damaged index says, so the file is looked through before it does.
  if (auto sound = check_bag_layout(file); !sound) return sound.error();
  console_bridge::noOutputHandler();  // what it would print is thrown as well, and told by us
  auto impl = std::make_unique<Impl>();
  impl->path = file;
  try {
    impl->bag.open(file.string(), rosbag::bagmode::Read);
    impl->read_index();
  } catch (const std::exception& fault) {
    return bad(file, fault.what());
  }
  return Bag(std::move(impl));
}

const std::filesystem::path& Bag::path() const { return impl_->path; }

const std::vector<Topic>& Bag::topics() const { return impl_->topics; }

Result<std::map<std::string, std::vector<Stamp>>> Bag::stamps(
    const std::vector<std::string>& topics, const Progress& progress) const {
  struct Place {
    ros::Time time;
    const std::string* topic;
    std::size_t index;
  };
  std::vector<Place> places;  // in the order of time, so that no chunk is unpacked twice
  std::map<std::string, std::vector<Stamp>> stamps;
  for (const std::string& topic : topics) {
    const auto found = impl_->messages.find(topic);
    if (found == impl_->messages.end()) continue;
    stamps[topic].resize(found->second.size());
    for (std::size_t index = 0; index < found->second.size(); ++index) {
      places.push_back({found->second[index].getTime(), &found->first, index});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.time < b.time; });
  ByteStream stream;
  std::size_t done = 0;
  for (const Place& place : places) {
    const auto stamp = impl_->stamp(*place.topic, place.index, stream);
    if (!stamp) return stamp.error();
    stamps[*place.topic][place.index] = *stamp;
    if (progress) progress(++done, places.size());
  }
  return stamps;
}

Result<ImageMessage> Bag::image(const std::string& topic, std::size_t index) const {
  return impl_->read(topic, index,
                     [&](const rosbag::MessageInstance& message) -> Result<ImageMessage> {
                       const std::string who = impl_->who(topic, index);
                       if (message.isType<sensor_msgs::Image>())
                         return parse_image(bytes_of(message), who);
                       if (message.isType<sensor_msgs::CompressedImage>()) {
                         return parse_compressed_image(bytes_of(message), who);
                       }
                       return bad(impl_->path, fmt::format("{} is a {}, not an image", topic,
                                                           std::string(message.getDataType())));
                     });
}

Result<CameraMessage> Bag::camera(const std::string& topic, std::size_t index) const {
  return impl_->read(
      topic, index, [&](const rosbag::MessageInstance& message) -> Result<CameraMessage> {
        if (message.isType<sensor_msgs::CameraInfo>()) {
          return parse_camera_info(bytes_of(message), impl_->who(topic, index));
        }
        return bad(impl_->path, fmt::format("{} is a {}, not a sensor_msgs/CameraInfo", topic,
                                            std::string(message.getDataType())));
      });
}

Bag::Bag(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Bag::Bag(Bag&&) noexcept = default;
Bag& Bag::operator=(Bag&&) noexcept = default;
Bag::~Bag() = default;

}  // namespace flowdlo::recording
