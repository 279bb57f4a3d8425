// SynthFolder: a data set of synthetic frames on disk. A frame folder is there whole or not at all,
// so that a run that was ended can be started again.
#pragma once

#include <filesystem>
#include <string>

#include "files/descriptor.hpp"
#include "flowdlo/result.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {

class SynthFolder {
 public:
  /// Makes `out` where needed, and removes what a run that was ended left half done.
  [[nodiscard]] static Result<SynthFolder> open(const std::filesystem::path& out);

  /// Whether the frame of `meta` (split, part, seed, index, frame) is there already. Fails with
  /// kBadInput when another frame has its place.
  [[nodiscard]] Result<bool> holds(const synth::Meta& meta) const;

  /// Writes a frame folder with truth.csv and meta.json. May run on several threads at once.
  [[nodiscard]] Result<void> save(const synth::SyntheticFrame& frame) const;

  SynthFolder(SynthFolder&& other) noexcept;
  SynthFolder& operator=(SynthFolder&&) = delete;
  SynthFolder(const SynthFolder&) = delete;
  SynthFolder& operator=(const SynthFolder&) = delete;
  ~SynthFolder();  ///< removes the folder of unfinished frames

 private:
  SynthFolder(std::filesystem::path out, std::filesystem::path unfinished, files::Descriptor lock);

  std::filesystem::path out_;
  std::filesystem::path unfinished_;
  files::Descriptor lock_;  ///< on it: says that this run lives
};

}  // namespace flowdlo::lab
