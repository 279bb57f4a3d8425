// Calibration: what the calibrated gate was fitted to. It belongs to the weights that it was fitted
// with: to a velocity model (.fdw) for frames whose mask alone is read, to a strand field
// (.safetensors) for frames that it sees.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "weights/stored_tensor.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {

inline constexpr std::string_view kCalibrationName = "calibration";  ///< prefix of its tensors
inline constexpr std::string_view kCalibrationVersion = "1";  ///< of the features that it weighs

/// Inputs, hidden units and outputs of one of its networks: gate/network.hpp.
struct CalibrationNetwork {
  std::string_view name;
  int inputs = 0;
  int hidden = 0;
  int outputs = 0;
};

inline constexpr int kCalibrationDraw = 26;  ///< numbers by which a draw is weighed
inline constexpr CalibrationNetwork kHypothesisNetwork{"hypothesis", 57, 32, 1};
inline constexpr CalibrationNetwork kClosenessNetwork{"closeness", 47, 8, 1};
inline constexpr CalibrationNetwork kNodeErrorNetwork{"node_error", 39, 16, 5};

/// Names and shapes: "calibration.draw" [26], of each network NAME "calibration.NAME.hidden"
/// [hidden, inputs], ".bent" [outputs, hidden] and ".straight" [outputs, inputs], and the scalars
/// "calibration.draw_margin", ".hypothesis_margin" and ".sigma_share".
[[nodiscard]] std::vector<Expected> calibration_manifest();

/// The tensor of that name, without "calibration.". It must be one of the manifest's.
[[nodiscard]] const Tensor& tensor_of(const Calibration& calibration, std::string_view name);

/// One that weighs nothing: the first hypothesis is chosen, and is as likely close as not.
[[nodiscard]] Calibration neutral_calibration();

/// What a file says of the section beside its tensors.
struct CalibrationHead {
  std::string_view version;
  std::string_view notes;
  std::optional<std::string_view> sha256;  ///< none: the file names none, and none is checked
};

/// Of a section as stored, f32 or f16. Every mismatch goes to `faults`.
[[nodiscard]] Calibration decode_calibration(const CalibrationHead& head,
                                             const std::vector<StoredTensor>& stored,
                                             std::vector<std::string>& faults);

/// A section as it is stored: f32, for it is small.
struct StoredCalibration {
  std::vector<std::vector<std::uint8_t>> bytes;
  std::vector<StoredTensor> tensors;  ///< views into them, and into the calibration's names
  std::string sha256;
};

/// Names, shapes or values that are unfit go to `faults`.
[[nodiscard]] StoredCalibration encode_calibration(const Calibration& calibration,
                                                   std::vector<std::string>& faults);

/// Puts the section behind what a .safetensors file holds otherwise: keys "calibration",
/// "calibration_notes" and "calibration_sha256" of its metadata, and its tensors. What is unfit
/// goes to `faults`.
void put_calibration(const Calibration& calibration, std::map<std::string, std::string>& metadata,
                     std::vector<StoredTensor>& stored,
                     std::vector<std::vector<std::uint8_t>>& encoded,
                     std::vector<std::string>& faults);

/// Takes the section's tensors out of a .safetensors file's; nothing where `metadata` names none.
/// Its digest may be missing there. Every mismatch goes to `faults`.
[[nodiscard]] std::optional<Calibration> take_calibration(
    const std::map<std::string, std::string>& metadata, std::vector<StoredTensor>& tensors,
    std::vector<std::string>& faults);

}  // namespace flowdlo::weights
