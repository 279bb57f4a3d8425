#include "recording/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "frame/faults.hpp"

namespace flowdlo::recording {
namespace {

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

}  // namespace

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

Result<void> read_stamps(const Bag& bag, const Progress& progress, Tracks& tracks) {
  const std::array<Track*, 4> all{&tracks.depth, &tracks.color, &tracks.mask, &tracks.camera};
  std::vector<std::string> topics;
  for (const Track* track : all) topics.push_back(track->topic);
  const auto stamps = bag.stamps(topics, progress);
  if (!stamps) return stamps.error();
  for (Track* track : all) {
    if (!track->topic.empty()) track->stamps = stamps->at(track->topic);
  }
  return {};
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

}  // namespace flowdlo::recording
