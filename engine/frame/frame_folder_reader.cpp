#include "flowdlo/frame_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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
using frame::PngFormat;
using frame::PngImage;

constexpr std::size_t kMaxImageBytes = std::size_t{1} << 28;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20;

/// What the files say, before they are held against each other. Empty images: absent or faulty.
struct Files {
  CameraFile camera;
  PngImage depth;      // 16 bits
  PngImage mask;       // 8 bits
  PngImage color;      // 8 bits, 3 channels
  PngImage instances;  // 16 bits
};

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() != fs::file_type::not_found;
}

std::string described(const PngImage& image) {
  const int channels = image.format().channels;
  return fmt::format("{}-bit, {} channel{}", image.format().bits, channels,
                     channels == 1 ? "" : "s");
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

PngImage load_png(const Source& source, Faults& faults) {
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

PngImage load_depth(const Source& source, Faults& faults) {
  PngImage depth = load_png(source, faults);
  const bool good = depth.format().bits == 16 && depth.format().channels == 1;
  if (depth.empty() || good) return depth;
  faults.bad_input(
      fmt::format("{}: expected a 16-bit image of 1 channel, got {}; write the depth "
                  "as 16-bit units of camera.json's depth_scale",
                  source.who, described(depth)));
  return {};
}

// The largest channel, not the luminance: a mask painted pure blue is a mask all the same.
PngImage largest_channel(const PngImage& image) {
  const auto channels = static_cast<std::size_t>(image.format().channels);
  PngImage largest({image.format().width, image.format().height});
  const std::uint8_t* from = image.values<std::uint8_t>().data();
  for (std::uint8_t& value : largest.values<std::uint8_t>()) {
    value = *std::max_element(from, from + std::min<std::size_t>(channels, 3));
    from += channels;
  }
  return largest;
}

PngImage load_mask(const Source& source, Faults& faults) {
  PngImage mask = load_png(source, faults);
  if (mask.empty()) return {};
  if (mask.format().bits != 8) {
    faults.bad_input(fmt::format("{}: expected an 8-bit image, got {}; write the rope as 255",
                                 source.who, described(mask)));
    return {};
  }
  if (mask.format().channels != 1) mask = largest_channel(mask);
  const auto values = std::as_const(mask).values<std::uint8_t>();
  if (*std::max_element(values.begin(), values.end()) == 1) {
    faults.bad_input(source.who +
                     ": expected the rope over 127, got values of 0 and 1; multiply by 255");
    return {};
  }
  return mask;
}

// Blue, green and red of what has one channel or four.
PngImage three_channels(const PngImage& image) {
  const auto channels = static_cast<std::size_t>(image.format().channels);
  PngImage bgr({image.format().width, image.format().height, 3});
  const std::uint8_t* from = image.values<std::uint8_t>().data();
  std::uint8_t* to = bgr.values<std::uint8_t>().data();
  for (std::size_t i = 0; i < bgr.format().values() / 3; ++i, from += channels) {
    for (std::size_t c = 0; c < 3; ++c) *to++ = from[channels == 1 ? 0 : c];
  }
  return bgr;
}

PngImage load_color(const Source& source, Faults& faults) {
  if (!source.is_there()) return {};  // no estimate needs it
  PngImage color = load_png(source, faults);
  if (color.empty()) return {};
  if (color.format().bits != 8) {
    faults.bad_input(fmt::format("{}: expected an 8-bit image, got {}; convert it to 8-bit BGR",
                                 source.who, described(color)));
    return {};
  }
  return color.format().channels == 3 ? color : three_channels(color);
}

PngImage load_instances(const Source& source, Faults& faults) {
  if (!source.is_there()) return {};  // the mask may be one rope, or nobody knows which is which
  PngImage labels = load_png(source, faults);
  if (labels.empty()) return {};
  if (labels.format().channels != 1) {
    faults.bad_input(
        fmt::format("{}: expected one channel of 8 or 16 bits, got {}; write each rope's number, 0 "
                    "where there is none",
                    source.who, described(labels)));
    return {};
  }
  if (labels.format().bits == 16) return labels;
  PngImage wide({labels.format().width, labels.format().height, 1, 16});
  const auto narrow = std::as_const(labels).values<std::uint8_t>();
  std::copy(narrow.begin(), narrow.end(), wide.values<std::uint16_t>().begin());
  return wide;
}

void check_size(const fs::path& file, const PngImage& image, const char* other, int width,
                int height, Faults& faults) {
  const PngFormat& format = image.format();
  if (image.empty() || (format.width == width && format.height == height)) return;
  faults.bad_input(fmt::format("{}: expected {} x {} px as in {}, got {} x {}; align the images",
                               files::shown(file), width, height, other, format.width,
                               format.height));
}

void check_sizes(const fs::path& folder, Files& files, Faults& faults) {
  auto& [camera, depth, mask, color, instances] = files;
  const char* reference = "camera.json";
  if (camera.width == 0 || camera.height == 0) {
    const bool from_depth = !depth.empty();
    reference = from_depth ? "depth.png" : "mask.png";
    const PngFormat& format = (from_depth ? depth : mask).format();
    camera.width = format.width;
    camera.height = format.height;
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

template <class Value>
std::vector<Value> values_of(const PngImage& image) {
  const auto values = image.values<Value>();
  return {values.begin(), values.end()};
}

std::vector<float> metres_of(const PngImage& depth, double scale_m) {
  std::vector<float> depth_m;
  depth_m.reserve(depth.format().values());
  for (const std::uint16_t unit : depth.values<std::uint16_t>()) {
    depth_m.push_back(geometry::metres(unit, scale_m));
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
                     values_of<std::uint8_t>(files.mask),
                     values_of<std::uint8_t>(files.color),
                     truth,
                     values_of<std::uint16_t>(files.instances)};
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
