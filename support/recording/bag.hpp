// Bag: the messages of a ROS 1 bag file that frames are made of. C++17, as the headers of ROS are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "recording/bag_message.hpp"

namespace flowdlo::recording {

/// Nanoseconds of a message's header; of its arrival where the header has none.
using Stamp = std::int64_t;

/// How many messages of how many were read.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

struct Topic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image"
  std::size_t messages = 0;
};

/// One thread at a time.
class Bag {
 public:
  /// Reads the index. Fails with kIo, or with kBadInput where the file is no bag, was cut off, or
  /// was never closed.
  [[nodiscard]] static Result<Bag> open(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& path() const;
  /// By name.
  [[nodiscard]] const std::vector<Topic>& topics() const;
  /// Of every message of `topics`, in the order of their arrival. Reads all of them, which takes
  /// its time: `progress` may be empty.
  [[nodiscard]] Result<std::map<std::string, std::vector<Stamp>>> stamps(
      const std::vector<std::string>& topics, const Progress& progress) const;
  /// The topic's message of that place in the order of arrival.
  [[nodiscard]] Result<ImageMessage> image(const std::string& topic, std::size_t index) const;
  [[nodiscard]] Result<CameraMessage> camera(const std::string& topic, std::size_t index) const;

  Bag(Bag&&) noexcept;
  Bag& operator=(Bag&&) noexcept;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;
  ~Bag();

 private:
  struct Impl;
  explicit Bag(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo::recording
