// BagWriter: recordings for tests, written by rosbag itself. C++17, as its headers are.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "recording/bag.hpp"

namespace flowdlo::test {

enum class Packing { kPlain, kBz2, kLz4 };

class BagWriter {
 public:
  /// Chunks are small, so that a bag of few images has several.
  explicit BagWriter(const std::filesystem::path& file, Packing packing = Packing::kPlain);
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;
  ~BagWriter();  ///< closes the bag

  /// The header carries `stamp`; the message arrives `late_ns` after it. A stamp of 0 stays none.
  void image(const std::string& topic, recording::Stamp stamp,
             const recording::ImageMessage& message, recording::Stamp late_ns = 3000000);
  void camera(const std::string& topic, recording::Stamp stamp,
              const recording::CameraMessage& message);
  void text(const std::string& topic, recording::Stamp stamp, const std::string& words);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo::test
