#include "flowdlo/frame_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <system_error>

#include "files/open_together.hpp"
#include "files/shown_name.hpp"
#include "frame/camera_json.hpp"
#include "frame/centerline_csv.hpp"
#include "frame/faults.hpp"
#include "frame/frame_folder.hpp"
#include "frame/frame_name.hpp"
#include "frame/limits.hpp"
#include "frame/png.hpp"
#include "geometry/depth.hpp"
#include "guard/guarded.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using frame::CameraFile;
using frame::Faults;

constexpr std::size_t kMaxImageBytes = std::size_t{1} << 28;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20;

/// What the files say, before they are held against each other. Empty images: absent or faulty.
struct Files {
  CameraFile camera;
  cv::Mat depth;      // CV_16UC1
  cv::Mat mask;       // CV_8UC1
  cv::Mat color;      // CV_8UC3
  cv::Mat instances;  // CV_16UC1
};

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() != fs::file_type::not_found;
}

std::string described(const cv::Mat& image) {
  return fmt::format("{}-bit, {} channel{}", image.depth() == CV_16U ? 16 : 8, image.channels(),
                     image.channels() == 1 ? "" : "s");
}

/// One of the folder's files, opened beside the others.
struct Source {
  std::string who;  ///< its path, for messages
  files::TogetherFile opened;

  [[nodiscard]] bool is_there() const { return opened.file || opened.error; }
};

/// What is in the file. None, and a fault, where it is absent, empty, too large or unreadable.
std::optional<files::FileBytes> content(const Source& source, std::size_t max_bytes,
                                        Faults& faults) {
  if (!source.is_there()) {
    faults.add({ErrorCode::kIo, source.who + ": expected a file, found none; add it"});
    return std::nullopt;
  }
  if (source.opened.error) {
    faults.add(*source.opened.error);
    return std::nullopt;
  }
  auto bytes = source.opened.file->read(max_bytes);
  if (!bytes) {
    faults.add(bytes.error());
    return std::nullopt;
  }
  if (bytes->size > 0) return std::move(*bytes);
  faults.bad_input(source.who + ": the file is empty; write it again");
  return std::nullopt;
}

cv::Mat load_png(const Source& source, Faults& faults) {
  const auto bytes = content(source, kMaxImageBytes, faults);
  if (!bytes) return {};
  auto image = frame::decode_png(bytes->view(), source.who);
  if (!image) {
    faults.add(image.error());
    return {};
  }
  return *image;
}

CameraFile load_camera(const Source& source, Faults& faults) {
  const auto bytes = content(source, kMaxTextBytes, faults);
  if (!bytes) return {};
  const auto camera = frame::parse_camera(bytes->text(), source.who);
  if (!camera) {
    faults.add(camera.error());
    return {};
  }
  return *camera;
}

cv::Mat load_depth(const Source& source, Faults& faults) {
  cv::Mat depth = load_png(source, faults);
  if (depth.empty() || depth.type() == CV_16UC1) return depth;
  faults.bad_input(
      fmt::format("{}: expected a 16-bit image of 1 channel, got {}; write the depth "
                  "as 16-bit units of camera.json's depth_scale",
                  source.who, described(depth)));
  return {};
}

// The largest channel, not the luminance: a mask painted pure blue is a mask all the same.
cv::Mat largest_channel(const cv::Mat& image) {
  std::vector<cv::Mat> channels;
  cv::split(image, channels);
  cv::Mat largest = channels[0];
  for (std::size_t c = 1; c < std::min<std::size_t>(channels.size(), 3); ++c) {
    cv::max(largest, channels[c], largest);
  }
  return largest;
}

cv::Mat load_mask(const Source& source, Faults& faults) {
  cv::Mat mask = load_png(source, faults);
  if (mask.empty()) return {};
  if (mask.depth() != CV_8U) {
    faults.bad_input(fmt::format("{}: expected an 8-bit image, got {}; write the rope as 255",
                                 source.who, described(mask)));
    return {};
  }
  if (mask.channels() != 1) mask = largest_channel(mask);
  double largest = 0;
  cv::minMaxLoc(mask, nullptr, &largest);
  if (largest == 1) {
    faults.bad_input(source.who +
                     ": expected the rope over 127, got values of 0 and 1; multiply by 255");
    return {};
  }
  return mask;
}

cv::Mat load_color(const Source& source, Faults& faults) {
  if (!source.is_there()) return {};  // no estimate needs it
  cv::Mat color = load_png(source, faults);
  if (color.empty()) return {};
  if (color.depth() != CV_8U) {
    faults.bad_input(fmt::format("{}: expected an 8-bit image, got {}; convert it to 8-bit BGR",
                                 source.who, described(color)));
    return {};
  }
  cv::Mat bgr;
  if (color.channels() == 3) return color;
  cv::cvtColor(color, bgr, color.channels() == 4 ? cv::COLOR_BGRA2BGR : cv::COLOR_GRAY2BGR);
  return bgr;
}

cv::Mat load_instances(const Source& source, Faults& faults) {
  if (!source.is_there()) return {};  // the mask may be one rope, or nobody knows which is which
  cv::Mat labels = load_png(source, faults);
  if (labels.empty()) return {};
  if (labels.channels() != 1) {
    faults.bad_input(
        fmt::format("{}: expected one channel of 8 or 16 bits, got {}; write each rope's number, 0 "
                    "where there is none",
                    source.who, described(labels)));
    return {};
  }
  labels.convertTo(labels, CV_16U);
  return labels;
}

void check_size(const fs::path& file, const cv::Mat& image, const char* other, int width,
                int height, Faults& faults) {
  if (image.empty() || (image.cols == width && image.rows == height)) return;
  faults.bad_input(fmt::format("{}: expected {} x {} px as in {}, got {} x {}; align the images",
                               files::shown(file), width, height, other, image.cols, image.rows));
}

void check_sizes(const fs::path& folder, Files& files, Faults& faults) {
  auto& [camera, depth, mask, color, instances] = files;
  const char* reference = "camera.json";
  if (camera.width == 0 || camera.height == 0) {
    const bool from_depth = !depth.empty();
    reference = from_depth ? "depth.png" : "mask.png";
    camera.width = from_depth ? depth.cols : mask.cols;
    camera.height = from_depth ? depth.rows : mask.rows;
  }
  if (camera.width == 0) return;  // no image could be read, which is a fault already
  check_size(folder / "depth.png", depth, reference, camera.width, camera.height, faults);
  check_size(folder / "mask.png", mask, reference, camera.width, camera.height, faults);
  check_size(folder / "color.png", color, reference, camera.width, camera.height, faults);
  check_size(folder / "instances.png", instances, reference, camera.width, camera.height, faults);
}

std::optional<Centerline> load_truth(const Source& source, Faults& faults) {
  if (!source.is_there()) return std::nullopt;
  const auto bytes = content(source, kMaxTextBytes, faults);
  if (!bytes) return std::nullopt;
  const auto truth = frame::parse_centerline(bytes->text(), source.who);
  if (truth) return *truth;
  faults.add(truth.error());
  return std::nullopt;
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& image) {
  if (image.empty()) return {};
  const cv::Mat packed = image.isContinuous() ? image : image.clone();
  return {packed.datastart, packed.datastart + packed.total() * packed.elemSize()};
}

std::vector<std::uint16_t> labels_of(const cv::Mat& instances) {
  if (instances.empty()) return {};
  return {instances.begin<std::uint16_t>(), instances.end<std::uint16_t>()};
}

std::vector<float> metres_of(const cv::Mat& depth, double scale_m) {
  std::vector<float> depth_m;
  depth_m.reserve(depth.total());
  for (int v = 0; v < depth.rows; ++v) {
    const auto* row = depth.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.cols; ++u) depth_m.push_back(geometry::metres(row[u], scale_m));
  }
  return depth_m;
}

}  // namespace

Result<FrameFolder> frame::load_folder(const fs::path& folder, const files::SystemCalls& calls,
                                       MaskFile mask) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure)) {
    return Error{ErrorCode::kIo,
                 fmt::format("{}: expected a folder with depth.png,{} and camera.json, got {}; "
                             "check the path",
                             files::shown(folder), mask == MaskFile::kNeeded ? " mask.png" : "",
                             is_there(folder) ? "no folder" : "nothing")};
  }
  auto opened = files::open_together(folder, frame::kFrameFiles, calls);
  if (!opened) return opened.error();
  const auto source = [&](std::size_t i) {
    return Source{files::shown(folder / frame::kFrameFiles[i]), std::move((*opened)[i])};
  };
  Faults faults;
  Files files;
  files.camera = load_camera(source(0), faults);
  files.depth = load_depth(source(1), faults);
  if (mask == MaskFile::kNeeded) files.mask = load_mask(source(2), faults);
  files.color = load_color(source(3), faults);
  auto truth = load_truth(source(4), faults);
  files.instances = load_instances(source(5), faults);
  check_sizes(folder, files, faults);
  if (!faults.empty()) return faults.error();

  FrameFolder loaded{frame::frame_name(folder),
                     files.camera.width,
                     files.camera.height,
                     files.camera.intrinsics,
                     metres_of(files.depth, files.camera.depth_scale_m),
                     bytes_of(files.mask),
                     bytes_of(files.color),
                     truth,
                     labels_of(files.instances)};
  if (mask == MaskFile::kNotRead) loaded.mask.assign(loaded.depth_m.size(), 0);
  if (const auto valid = validate(loaded.frame()); !valid) return valid.error();
  return loaded;
}

Result<FrameFolder> load_frame_folder(const fs::path& folder) {
  return guard::guarded("load_frame_folder",
                        [&] { return frame::load_folder(folder, files::kernel()); });
}

Result<FrameFolder> load_frame_folder_without_mask(const fs::path& folder) {
  return guard::guarded("load_frame_folder_without_mask", [&] {
    return frame::load_folder(folder, files::kernel(), frame::MaskFile::kNotRead);
  });
}

}  // namespace flowdlo
