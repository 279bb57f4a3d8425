// KeptFile: a verified weights file as it was read. Where its tensors are f16 it takes half of what
// they take decoded, and makes them anew without touching the disk.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "weights/file.hpp"
#include "weights/location.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {

class KeptFile {
 public:
  [[nodiscard]] const Metadata& metadata() const { return metadata_; }
  [[nodiscard]] const std::optional<Calibration>& calibration() const { return calibration_; }

  /// The same model as `load` gives, without the sections beside it.
  [[nodiscard]] Weights decoded() const;

 private:
  friend Result<KeptFile> keep(const Place& place);
  KeptFile(files::FileBytes read, std::span<const std::uint8_t> bytes, Metadata metadata,
           std::optional<Calibration> calibration)
      : read_(std::move(read)),
        bytes_(bytes),
        metadata_(std::move(metadata)),
        calibration_(std::move(calibration)) {}

  files::FileBytes read_;                ///< empty where the bytes are the library's own
  std::span<const std::uint8_t> bytes_;  ///< all of the file
  Metadata metadata_;
  std::optional<Calibration> calibration_;
};

/// Verifies all that `load` does, keeps the file's bytes, and decodes no tensor of the model; bytes
/// within the library stay where they are. Fails as `load` does.
[[nodiscard]] Result<KeptFile> keep(const Place& place);

}  // namespace flowdlo::weights
