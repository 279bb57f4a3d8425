// Coverage tables: which method answers, why others do not, and how well answers agree with the
// mask; with or without truth.
#pragma once

#include <string>

#include "eval/scene_group.hpp"

namespace flowdlo::eval {

/// A row a method: valid, invalid, no output, mask consistency of what is valid, errors where there
/// is truth, and the reasons with their counts.
[[nodiscard]] std::string availability_table(const DataSet& data_set);

/// A row a frame: outputs, accepted draws and mask consistency, Table 4.3's columns.
[[nodiscard]] std::string frame_table(const DataSet& data_set);

/// Table 4.3: the frames without truth as one recording, and the thesis' three. Empty where every
/// frame has a truth.
[[nodiscard]] std::string recording_table(const DataSet& data_set);

/// Reliability of the confidence in ten bins, expected calibration error, and how many nodes lie
/// within one and two sigma_m. Empty without truth.
[[nodiscard]] std::string calibration_table(const DataSet& data_set);

/// One bin of the reliability diagram.
struct ReliabilityBin {
  int scenes = 0;
  double said = 0;  ///< mean confidence
  double was = 0;   ///< share of estimates with an index error below 1 cm, Eq. (4.3)
};

/// Bins that hold a scene, in order.
[[nodiscard]] std::vector<ReliabilityBin> reliability(const std::vector<const Trial*>& trials);

/// Mean of |said - was| over scenes.
[[nodiscard]] double expected_calibration_error(const std::vector<ReliabilityBin>& bins);

}  // namespace flowdlo::eval
