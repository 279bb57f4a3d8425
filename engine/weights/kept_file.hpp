// KeptFile: a verified weights file as it was read. Where its tensors are f16 it takes half of what
// they take decoded, and makes them anew without touching the disk.
#pragma once

#include <filesystem>
#include <memory>

#include "weights/file.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {

struct Loaded;

class KeptFile {
 public:
  /// The same as `load` gave.
  [[nodiscard]] Weights decoded() const;

 private:
  friend Result<Loaded> load_and_keep(const std::filesystem::path& file);
  KeptFile(files::FileBytes bytes, Metadata metadata)
      : bytes_(std::move(bytes)), metadata_(std::move(metadata)) {}

  files::FileBytes bytes_;
  Metadata metadata_;
};

/// What a file holds, and the file.
struct Loaded {
  std::shared_ptr<const Weights> weights;
  std::shared_ptr<const KeptFile> file;
};

/// As `load`, and keeps the file's bytes.
[[nodiscard]] Result<Loaded> load_and_keep(const std::filesystem::path& file);

}  // namespace flowdlo::weights
