// DrawnRecording: a rope as a camera driver would publish it.
#pragma once

#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "recording/bag_writer.hpp"
#include "scene/scene.hpp"

namespace flowdlo::test {

inline constexpr const char* kColor = "/camera/color/image_raw";
inline constexpr const char* kDepth = "/camera/aligned_depth_to_color/image_raw";
inline constexpr const char* kInfo = "/camera/color/camera_info";
inline constexpr const char* kMask = "/rope/mask";
inline constexpr recording::Stamp kMillisecond_ns = 1000000;
inline constexpr recording::Stamp kStart_ns = 1600000000LL * 1000000000LL;

inline recording::ImageMessage raw_message(const cv::Mat& pixels, const std::string& encoding) {
  const cv::Mat packed = pixels.isContinuous() ? pixels : pixels.clone();
  recording::ImageMessage message;
  message.width = static_cast<std::uint32_t>(packed.cols);
  message.height = static_cast<std::uint32_t>(packed.rows);
  message.encoding = encoding;
  message.step = static_cast<std::uint32_t>(packed.step[0]);
  message.data.assign(packed.datastart, packed.dataend);
  return message;
}

inline recording::ImageMessage packed_message(const cv::Mat& pixels, const std::string& extension,
                                              const std::string& format) {
  recording::ImageMessage message;
  message.compressed = true;
  message.format = format;
  cv::imencode(extension, pixels, message.data);
  return message;
}

/// compressedDepth: a header of 12 bytes, then a PNG of a / depth_m + b.
inline recording::ImageMessage packed_depth_message(const cv::Mat& values,
                                                    const std::string& format, float a = 0,
                                                    float b = 0) {
  recording::ImageMessage message = packed_message(values, ".png", format);
  std::vector<std::uint8_t> header(12);
  std::memcpy(header.data() + 4, &a, sizeof(a));
  std::memcpy(header.data() + 8, &b, sizeof(b));
  message.data.insert(message.data.begin(), header.begin(), header.end());
  return message;
}

struct DrawnImages {
  explicit DrawnImages(const lab::Scene& scene)
      : color(cv::Size(scene.image.width, scene.image.height), CV_8UC3),
        mask(color.size(), CV_8UC1),
        depth_m(color.size(), CV_32FC1),
        depth_mm(color.size(), CV_16UC1) {
    std::memcpy(color.data, scene.image.color_bgr.data(), scene.image.color_bgr.size());
    std::memcpy(mask.data, scene.image.mask.data(), scene.image.mask.size());
    std::memcpy(depth_m.data, scene.image.depth_m.data(), 4 * scene.image.depth_m.size());
    for (int v = 0; v < depth_m.rows; ++v) {
      for (int u = 0; u < depth_m.cols; ++u) {
        const float depth = depth_m.at<float>(v, u);
        const bool there = std::isfinite(depth) && depth > 0 && depth < 65;
        depth_mm.at<std::uint16_t>(v, u) =
            there ? static_cast<std::uint16_t>(std::lround(1000 * depth)) : std::uint16_t{0};
      }
    }
    // A blue rope on grey, so that thresholds can find it.
    color.setTo(cv::Scalar(90, 90, 90));
    color.setTo(cv::Scalar(220, 40, 30), mask);
  }

  [[nodiscard]] cv::Mat rgb() const {
    cv::Mat swapped;
    cv::cvtColor(color, swapped, cv::COLOR_BGR2RGB);
    return swapped;
  }

  cv::Mat color;
  cv::Mat mask;
  cv::Mat depth_m;
  cv::Mat depth_mm;
};

inline recording::CameraMessage camera_message(const lab::Scene& scene) {
  const Intrinsics& camera = scene.image.camera;
  recording::CameraMessage message;
  message.width = static_cast<std::uint32_t>(scene.image.width);
  message.height = static_cast<std::uint32_t>(scene.image.height);
  message.model = "plumb_bob";
  message.d.assign(5, 0.0);
  message.k = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  message.p = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  return message;
}

inline constexpr const char* kBlue = "110,100,50,130,255,255";

/// `frames` sets of images at 10 Hz; colours and masks jitter by up to 4 ms around the depths.
inline void write_recording(const std::filesystem::path& file, const lab::Scene& scene, int frames,
                            Packing packing = Packing::kPlain) {
  const DrawnImages images(scene);
  BagWriter bag(file, packing);
  for (int i = 0; i < frames; ++i) {
    const recording::Stamp at = kStart_ns + 100 * i * kMillisecond_ns;
    const recording::Stamp jitter = (i * 7 % 9 - 4) * kMillisecond_ns;
    bag.camera(kInfo, at, camera_message(scene));
    bag.image(kDepth, at, raw_message(images.depth_mm, "16UC1"), 20 * kMillisecond_ns);
    bag.image(kColor, at + jitter, raw_message(images.rgb(), "rgb8"));
    bag.image(kMask, at - jitter, raw_message(images.mask, "mono8"), 30 * kMillisecond_ns);
    bag.text("/rosout", at, "a word");
  }
}

}  // namespace flowdlo::test
