#include "recording/recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "frame/faults.hpp"
#include "recording/bag.hpp"
#include "recording/bag_image.hpp"
#include "recording/hsv.hpp"
#include "recording/matched_sets.hpp"
#include "recording/rectification.hpp"
#include "recording/tracks.hpp"

namespace flowdlo::recording {
namespace {

namespace fs = std::filesystem;

constexpr double kNanosecondsAMillisecond = 1e6;

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
    image::Image<float> depth_m;
    support::Picture color;
    image::Mask mask;
  };

  [[nodiscard]] Result<Images> decode(const Messages& messages, const MatchedSet& set) const {
    Images images;
    frame::Faults faults;
    const auto take = [&](auto image, auto& to) {
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

  void check_size(const image::Size& got, const Track& track, std::size_t message,
                  const image::Size& size, frame::Faults& faults) const {
    if (got.empty() || got == size) return;
    faults.bad_input(
        fmt::format("{}: expected {} x {} px as in the camera info, got {} x {}; depth, "
                    "colour and mask have to be aligned to one camera, whose info "
                    "--camera-topic names",
                    who(track, message), size.width, size.height, got.width, got.height));
  }

  [[nodiscard]] Result<FrameFolder> frame(const MatchedSet& set, const std::string& name) const {
    const auto messages = read(set);
    if (!messages) return messages.error();
    const auto lens = rectification(messages->camera, set);
    if (!lens) return lens.error();
    auto images = decode(*messages, set);
    if (!images) return images.error();
    frame::Faults faults;
    check_size(images->depth_m.size(), tracks.depth, set.depth, lens->size(), faults);
    check_size(images->color.size(), tracks.color, set.color, lens->size(), faults);
    check_size(images->mask.size(), tracks.mask, set.mask, lens->size(), faults);
    if (!faults.empty()) return faults.error();
    // Of the colours as they were seen: interpolated ones belong to neither side.
    if (options.hsv) {
      const auto& h = *options.hsv;
      images->mask = hsv_mask(images->color, {{h[0], h[1], h[2]}, {h[3], h[4], h[5]}});
    }
    const auto depth_m = lens->nearest(images->depth_m);
    const auto mask = lens->nearest(images->mask);
    const auto color = images->color.empty() ? images->color : lens->color(images->color);
    FrameFolder folder;
    folder.name = name;
    folder.width = depth_m.width();
    folder.height = depth_m.height();
    folder.intrinsics = lens->intrinsics();
    folder.depth_m.assign(depth_m.data(), depth_m.data() + depth_m.total());
    folder.mask.assign(mask.data(), mask.data() + mask.total());
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(color.data());
    folder.color_bgr.assign(bytes, bytes + sizeof(support::Color) * color.total());
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
                                                         const RecordingOptions& options,
                                                         const Progress& progress) {
  if (auto sound = check(options, file.string()); !sound) return sound.error();
  auto bag = Bag::open(file);
  if (!bag) return bag.error();
  auto impl = std::make_unique<Impl>(*std::move(bag));
  impl->options = options;
  auto tracks = choose_tracks(impl->bag, options);
  if (!tracks) return tracks.error();
  impl->tracks = *std::move(tracks);
  if (auto read = read_stamps(impl->bag, progress, impl->tracks); !read) return read.error();
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
