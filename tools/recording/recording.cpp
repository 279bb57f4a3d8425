#include "recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "frame/faults.hpp"
#include "recording/bag.hpp"
#include "recording/bag_image.hpp"
#include "recording/rectification.hpp"
#include "recording/stamp_match.hpp"

namespace flowdlo::recording {
namespace {

namespace fs = std::filesystem;

constexpr double kNanosecondsAMillisecond = 1e6;
constexpr double kNanosecondsASecond = 1e9;

/// A topic and the stamps of its messages; without a name: not in use.
struct Track {
  std::string topic;
  std::vector<Stamp> stamps;
};

struct Tracks {
  Track depth;
  Track color;
  Track mask;
  Track camera;
};

/// Indices of the messages that make one frame.
struct MatchedSet {
  std::size_t number = 0;  ///< among all that were matched
  std::size_t depth = 0;
  std::size_t color = 0;
  std::size_t mask = 0;
  std::size_t camera = 0;
};

std::string listed(const std::vector<Topic>& topics) {
  std::string words;
  for (const Topic& topic : topics) {
    words += fmt::format("\n  {} ({}, {} messages)", topic.name, topic.type, topic.messages);
  }
  return words.empty() ? " nothing" : words;
}

bool is_image(const std::string& type) {
  return type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage";
}

bool is_camera(const std::string& type) { return type == "sensor_msgs/CameraInfo"; }

const Topic* find(const std::vector<Topic>& topics, const std::string& name) {
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const Topic& topic) { return topic.name == name; });
  return found == topics.end() || found->messages == 0 ? nullptr : &*found;
}

/// `name` or its compressed form; nullptr when neither is there.
const Topic* find_any_form(const std::vector<Topic>& topics, const std::string& name) {
  for (const char* form : {"", "/compressed", "/compressedDepth"}) {
    if (const Topic* topic = find(topics, name + form)) return topic;
  }
  return nullptr;
}

/// The name of the topic to read, or a fault and nothing.
std::string chosen(const Bag& bag, const std::string& name, const char* option,
                   bool (*fits)(const std::string&), const char* kind, frame::Faults& faults) {
  const Topic* topic = find_any_form(bag.topics(), name);
  if (topic != nullptr && fits(topic->type)) return topic->name;
  faults.bad_input(fmt::format("{}: expected {} on {} \"{}\", got {}", bag.path().string(), kind,
                               option, name, topic == nullptr ? "no message" : topic->type));
  return {};
}

Result<Tracks> choose_tracks(const Bag& bag, const RecordingOptions& options) {
  frame::Faults faults;
  Tracks tracks;
  constexpr const char* kImage = "sensor_msgs/Image or CompressedImage";
  tracks.depth.topic = chosen(bag, options.depth_topic, "--depth-topic", is_image, kImage, faults);
  const bool color_there = find_any_form(bag.topics(), options.color_topic) != nullptr;
  if (options.hsv || options.color_required || color_there) {
    tracks.color.topic =
        chosen(bag, options.color_topic, "--color-topic", is_image, kImage, faults);
  }
  if (!options.mask_topic.empty()) {
    tracks.mask.topic = chosen(bag, options.mask_topic, "--mask-topic", is_image, kImage, faults);
  }
  tracks.camera.topic = chosen(bag, options.camera_topic, "--camera-topic", is_camera,
                               "sensor_msgs/CameraInfo", faults);
  if (faults.empty()) return tracks;
  return Error{faults.error().code,
               faults.error().message + "\nthe bag has:" + listed(bag.topics())};
}

Result<void> read_stamps(const Bag& bag, Tracks& tracks) {
  for (Track* track : {&tracks.depth, &tracks.color, &tracks.mask, &tracks.camera}) {
    if (track->topic.empty()) continue;
    auto stamps = bag.stamps(track->topic);
    if (!stamps) return stamps.error();
    track->stamps = *std::move(stamps);
  }
  return {};
}

/// Every depth image with its partners, in the order of their stamps.
std::vector<MatchedSet> matched(const Tracks& tracks, Stamp tolerance_ns) {
  const auto& depth = tracks.depth.stamps;
  const auto color = match_stamps(depth, tracks.color.stamps, tolerance_ns);
  const auto mask = match_stamps(depth, tracks.mask.stamps, tolerance_ns);
  std::vector<std::size_t> order(depth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  std::vector<MatchedSet> sets;
  for (const std::size_t i : order) {
    const bool has_color = tracks.color.topic.empty() || color[i].has_value();
    const bool has_mask = tracks.mask.topic.empty() || mask[i].has_value();
    if (!has_color || !has_mask) continue;
    sets.push_back({sets.size(), i, color[i].value_or(0), mask[i].value_or(0),
                    latest_until(tracks.camera.stamps, depth[i])});
  }
  return sets;
}

std::vector<MatchedSet> selected(const std::vector<MatchedSet>& sets, const Tracks& tracks,
                                 const RecordingOptions& options) {
  const auto& depth = tracks.depth.stamps;
  const Stamp first = *std::min_element(depth.begin(), depth.end());
  std::vector<MatchedSet> within;
  for (const MatchedSet& set : sets) {
    const double at_s = static_cast<double>(depth[set.depth] - first) / kNanosecondsASecond;
    if (at_s >= options.from_s && at_s <= options.to_s) within.push_back(set);
  }
  std::vector<MatchedSet> result;
  for (std::size_t i = 0; i < within.size(); i += static_cast<std::size_t>(options.every)) {
    result.push_back(within[i]);
  }
  return result;
}

/// Milliseconds from the depth image to the partner, at most.
double largest_gap_ms(const std::vector<MatchedSet>& sets, const Tracks& tracks) {
  Stamp largest = 0;
  for (const MatchedSet& set : sets) {
    const Stamp at = tracks.depth.stamps[set.depth];
    if (!tracks.color.topic.empty()) {
      largest = std::max(largest, std::abs(tracks.color.stamps[set.color] - at));
    }
    if (!tracks.mask.topic.empty()) {
      largest = std::max(largest, std::abs(tracks.mask.stamps[set.mask] - at));
    }
  }
  return static_cast<double>(largest) / kNanosecondsAMillisecond;
}

std::string counted(const Tracks& tracks) {
  std::string words = fmt::format("{} depth", tracks.depth.stamps.size());
  const auto add = [&](const Track& track, const char* what) {
    if (!track.topic.empty()) words += fmt::format(", {} {}", track.stamps.size(), what);
  };
  add(tracks.color, "colour");
  add(tracks.mask, "mask");
  return words + " images";
}

/// Why there is no frame.
Error no_frames(const Bag& bag, const Tracks& tracks, const std::vector<MatchedSet>& sets,
                const RecordingOptions& options) {
  if (!sets.empty()) {
    return {
        ErrorCode::kBadInput,
        fmt::format("{}: {} sets of messages match, but none lies from {:g} s to {:g} s; change "
                    "--from and --to",
                    bag.path().string(), sets.size(), options.from_s, options.to_s)};
  }
  const auto loose = matched(tracks, std::numeric_limits<Stamp>::max());
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected depth images with their partners within {:g} ms, got none ({}; "
                      "the nearest of all lie up to {:.1f} ms apart); raise --sync-tolerance, or "
                      "name other topics",
                      bag.path().string(), options.sync_tolerance_ms, counted(tracks),
                      largest_gap_ms(loose, tracks))};
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& image) {
  const cv::Mat packed = image.isContinuous() ? image : image.clone();
  return {packed.datastart, packed.dataend};
}

}  // namespace

struct Recording::Impl {
  explicit Impl(Bag opened) : bag(std::move(opened)) {}

  Bag bag;
  RecordingOptions options;
  Tracks tracks;
  std::vector<MatchedSet> sets;
  std::string summary;
  mutable std::mutex mutex;  // of the bag

  struct Messages {
    ImageMessage depth;
    ImageMessage color;
    ImageMessage mask;
    CameraMessage camera;
  };

  [[nodiscard]] std::string who(const Track& track, std::size_t message) const {
    return fmt::format("{}: {}, message {}", bag.path().string(), track.topic, message);
  }

  [[nodiscard]] Result<Messages> read(const MatchedSet& set) const {
    const std::lock_guard lock(mutex);
    Messages messages;
    const auto image = [&](const Track& track, std::size_t index,
                           ImageMessage& message) -> Result<void> {
      if (track.topic.empty()) return {};
      auto found = bag.image(track.topic, index);
      if (!found) return found.error();
      message = *std::move(found);
      return {};
    };
    if (auto done = image(tracks.depth, set.depth, messages.depth); !done) return done.error();
    if (auto done = image(tracks.color, set.color, messages.color); !done) return done.error();
    if (auto done = image(tracks.mask, set.mask, messages.mask); !done) return done.error();
    auto camera = bag.camera(tracks.camera.topic, set.camera);
    if (!camera) return camera.error();
    messages.camera = *std::move(camera);
    return messages;
  }

  [[nodiscard]] Result<Rectification> rectification(const CameraMessage& camera,
                                                    const MatchedSet& set) const {
    return Rectification::create(camera, options.rectified, who(tracks.camera, set.camera));
  }

  /// The pixels as the bag has them; images that are not in use stay empty.
  struct Images {
    cv::Mat depth_m;
    cv::Mat color;
    cv::Mat mask;
  };

  [[nodiscard]] Result<Images> decode(const Messages& messages, const MatchedSet& set) const {
    Images images;
    frame::Faults faults;
    const auto take = [&](Result<cv::Mat> image, cv::Mat& to) {
      if (image) {
        to = *image;
      } else {
        faults.add(image.error());
      }
    };
    take(depth_image(messages.depth, who(tracks.depth, set.depth)), images.depth_m);
    if (!tracks.color.topic.empty()) {
      take(color_image(messages.color, who(tracks.color, set.color)), images.color);
    }
    if (!tracks.mask.topic.empty()) {
      take(mask_image(messages.mask, who(tracks.mask, set.mask)), images.mask);
    }
    if (!faults.empty()) return faults.error();
    return images;
  }

  void check_size(const cv::Mat& image, const Track& track, std::size_t message, cv::Size size,
                  frame::Faults& faults) const {
    if (image.empty() || image.size() == size) return;
    faults.bad_input(
        fmt::format("{}: expected {} x {} px as in the camera info, got {} x {}; depth, "
                    "colour and mask have to be aligned to one camera, whose info "
                    "--camera-topic names",
                    who(track, message), size.width, size.height, image.cols, image.rows));
  }

  [[nodiscard]] Result<FrameFolder> frame(const MatchedSet& set, const std::string& name) const {
    const auto messages = read(set);
    if (!messages) return messages.error();
    const auto lens = rectification(messages->camera, set);
    if (!lens) return lens.error();
    auto images = decode(*messages, set);
    if (!images) return images.error();
    frame::Faults faults;
    check_size(images->depth_m, tracks.depth, set.depth, lens->size(), faults);
    check_size(images->color, tracks.color, set.color, lens->size(), faults);
    check_size(images->mask, tracks.mask, set.mask, lens->size(), faults);
    if (!faults.empty()) return faults.error();
    if (options
            .hsv) {  // of the colours as they were seen: interpolated ones belong to neither side
      const auto& h = *options.hsv;
      images->mask = hsv_mask(images->color, {{h[0], h[1], h[2]}, {h[3], h[4], h[5]}});
    }
    const cv::Mat depth_m = lens->nearest(images->depth_m);
    const auto* begin = depth_m.ptr<float>();
    FrameFolder folder;
    folder.name = name;
    folder.width = depth_m.cols;
    folder.height = depth_m.rows;
    folder.intrinsics = lens->intrinsics();
    folder.depth_m.assign(begin, begin + depth_m.total());
    folder.mask = bytes_of(lens->nearest(images->mask));
    if (!images->color.empty()) folder.color_bgr = bytes_of(lens->color(images->color));
    return folder;
  }

  [[nodiscard]] Result<std::string> described(std::size_t all) const {
    const auto camera = bag.camera(tracks.camera.topic, sets.front().camera);
    if (!camera) return camera.error();
    const auto lens = rectification(*camera, sets.front());
    if (!lens) return lens.error();
    const std::string bent =
        options.rectified ? "rectified, as --rectified says"
        : lens->largest_shift_px() > 0
            ? fmt::format("{} undone, up to {:.1f} px", camera->model, lens->largest_shift_px())
            : std::string("no distortion");
    return fmt::format("{}: {} of {} frames (of {}), within {:.1f} ms; {}", bag.path().string(),
                       sets.size(), all, counted(tracks), largest_gap_ms(sets, tracks), bent);
  }
};

Result<std::shared_ptr<const Recording>> Recording::open(const fs::path& file,
                                                         const RecordingOptions& options) {
  if (options.hsv.has_value() != options.mask_topic.empty()) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected one way to the rope's mask, got {}; give --hsv or "
                             "--mask-topic",
                             file.string(), options.hsv ? "two" : "none")};
  }
  auto bag = Bag::open(file);
  if (!bag) return bag.error();
  auto impl = std::make_unique<Impl>(*std::move(bag));
  impl->options = options;
  auto tracks = choose_tracks(impl->bag, options);
  if (!tracks) return tracks.error();
  impl->tracks = *std::move(tracks);
  if (auto read = read_stamps(impl->bag, impl->tracks); !read) return read.error();
  const auto tolerance_ns =
      static_cast<Stamp>(std::llround(options.sync_tolerance_ms * kNanosecondsAMillisecond));
  const auto sets = matched(impl->tracks, tolerance_ns);
  impl->sets = selected(sets, impl->tracks, options);
  if (impl->sets.empty()) return no_frames(impl->bag, impl->tracks, sets, options);
  auto summary = impl->described(sets.size());
  if (!summary) return summary.error();
  impl->summary = *std::move(summary);
  return std::shared_ptr<const Recording>(new Recording(std::move(impl)));
}

std::size_t Recording::size() const { return impl_->sets.size(); }

std::string Recording::name(std::size_t index) const {
  return fmt::format("{}_{:06d}", impl_->bag.path().stem().string(), impl_->sets[index].number);
}

const std::string& Recording::summary() const { return impl_->summary; }

Result<FrameFolder> Recording::load(std::size_t index) const {
  return impl_->frame(impl_->sets[index], name(index));
}

Recording::Recording(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recording::~Recording() = default;

}  // namespace flowdlo::recording
