// RopeCore: what the ROS nodes share. Images as any ROS has them go in, ropes come out; no header
// of ROS is read here, and none of FlowDLO's above, so that either may ask for its own C++.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace flowdlo_ros {

/// An image message's fields; the pixels stay the caller's.
struct Image {
  const std::uint8_t* data = nullptr;  ///< null: no image
  std::size_t bytes = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0;  ///< bytes from a row to the next
  bool big_endian = false;
  std::string encoding;  ///< depth 16UC1, mono16, 32FC1; mask mono8, 8UC1; colour bgr8, rgb8
};

/// A CameraInfo message's fields.
struct Camera {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::array<double, 9> k{};
  std::array<double, 12> p{};
  std::vector<double> d;
};

/// What the estimator is made with, once.
struct Setup {
  std::string weights;  ///< empty: those that ship
  std::string device = "auto";
  std::string quality = "auto";  ///< "full", "fast" or "auto"
  int ropes = 1;                 ///< 0: as many as there are
  int threads = 0;
  double rope_length_m = 0;
  bool ring = false;  ///< the rope is a ring, also where something lies over it; with one rope
  double budget_ms = 0;
  std::uint64_t seed = 0;
  double most_moved_m = 0.1;  ///< flowdlo::TrackerConfig's
  int patience = 30;
};

/// What may change from frame to frame.
struct Choices {
  bool rectified = false;         ///< P of the camera info holds, not K and D
  bool keep_order = true;         ///< ropes keep their numbers, and their ends their order
  bool table = false;             ///< without a mask: what stands out of the table
  std::vector<int> rope_color{};  ///< without a mask: red, green, blue of the rope, 0..255
  double color_tolerance = 0.12;
};

struct Rope {
  std::uint32_t number = 0;  ///< that it keeps through the stream, from 1; 0: it has none
  std::vector<std::array<float, 3>> nodes;  ///< 64, metres, camera frame
  std::vector<float> sigma_m;               ///< 64
  std::vector<bool> support;                ///< 64
  float confidence = 0;
  std::string source;  ///< name_of(Source)
  std::string origin;  ///< name_of(Origin)
  std::vector<std::string> doubts;
  bool closed = false;
};

struct Crossing {
  std::uint32_t over = 0;
  std::uint32_t under = 0;
  float over_at_m = 0;
  float under_at_m = 0;
  float apart_m = 0;
};

struct Seen {
  std::string error;  ///< empty: there are ropes
  std::vector<Rope> ropes{};
  std::vector<Crossing> crossings{};
  std::vector<std::uint32_t> missing{};  ///< numbers of ropes that are waited for
  double total_ms = 0;
};

/// One estimator and the stream so far. Not for several threads at a time.
class RopeCore {
 public:
  /// `error` is empty where it was made.
  RopeCore(const Setup& setup, std::string& error);
  ~RopeCore();
  RopeCore(const RopeCore&) = delete;
  RopeCore& operator=(const RopeCore&) = delete;

  /// The ropes of one set of images of one size. Of `mask` and `color` one may be missing: without
  /// a mask it is made as `choices` say.
  [[nodiscard]] Seen see(const Image& depth, const Image& mask, const Image& color,
                         const Camera& camera, const Choices& choices);

  /// Forgets the ropes of the frames before and the end that was set.
  void reset();

  /// The end nearest to this pixel becomes node 0, until reset().
  void set_end(float u, float v);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flowdlo_ros
