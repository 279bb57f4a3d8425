// KeptFile: a verified weights file as it was read. Where its tensors are f16 it takes half of what
// they take decoded, and makes them anew without touching the disk.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "weights/file.hpp"
#include "weights/location.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {

struct Loaded;

class KeptFile {
 public:
  /// The same model as `load` gave, without the sections beside it.
  [[nodiscard]] Weights decoded() const;

 private:
  friend Result<Loaded> load_and_keep(const Place& place);
  KeptFile(files::FileBytes read, std::span<const std::uint8_t> bytes, Metadata metadata)
      : read_(std::move(read)), bytes_(bytes), metadata_(std::move(metadata)) {}

  files::FileBytes read_;                ///< empty where the bytes are the library's own
  std::span<const std::uint8_t> bytes_;  ///< all of the file
  Metadata metadata_;
};

/// What a file holds, and the file.
struct Loaded {
  std::shared_ptr<const Weights> weights;
  std::shared_ptr<const KeptFile> file;
};

/// As `load`, and keeps the file's bytes; those within the library stay where they are.
[[nodiscard]] Result<Loaded> load_and_keep(const Place& place);

}  // namespace flowdlo::weights
