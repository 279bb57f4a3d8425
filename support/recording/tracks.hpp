// Tracks: the topics of a recording that frames are made of.
#pragma once

#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "recording/bag.hpp"
#include "recording/recording_options.hpp"

namespace flowdlo::recording {

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

/// Fails with kBadInput that lists every topic that is missing or of another type, and those that
/// the bag has. No stamps yet.
[[nodiscard]] Result<Tracks> choose_tracks(const Bag& bag, const RecordingOptions& options);

/// Fails as Bag::stamps() does.
[[nodiscard]] Result<void> read_stamps(const Bag& bag, const Progress& progress, Tracks& tracks);

/// "60 depth, 58 colour images".
[[nodiscard]] std::string counted(const Tracks& tracks);

}  // namespace flowdlo::recording
