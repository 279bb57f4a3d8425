// BagMessage: the messages of ROS that frames are made of, and how they lie in a bag. C++17, as
// bag.hpp is.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::recording {

/// sensor_msgs/Image, or sensor_msgs/CompressedImage: then `format` says how, and only it and
/// `data` are set.
struct ImageMessage {
  bool compressed = false;
  std::string format;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string encoding;
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::vector<std::uint8_t> data;
};

/// sensor_msgs/CameraInfo.
struct CameraMessage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string model;         ///< of the distortion
  std::vector<double> d;     ///< its coefficients
  std::array<double, 9> k;   ///< of the image as it was taken, row-major
  std::array<double, 12> p;  ///< of the rectified image, row-major
  bool cropped = false;      ///< by binning or a region of interest
};

/// Of a message's bytes, as sensor_msgs/Image lays them out. Fails with kBadInput where the message
/// is shorter than the lengths in it say, and takes no memory for what is not there. The text
/// begins with `who`.
[[nodiscard]] Result<ImageMessage> parse_image(const std::vector<std::uint8_t>& bytes,
                                               const std::string& who);

/// The same of a sensor_msgs/CompressedImage.
[[nodiscard]] Result<ImageMessage> parse_compressed_image(const std::vector<std::uint8_t>& bytes,
                                                          const std::string& who);

/// The same of a sensor_msgs/CameraInfo.
[[nodiscard]] Result<CameraMessage> parse_camera_info(const std::vector<std::uint8_t>& bytes,
                                                      const std::string& who);

}  // namespace flowdlo::recording
