// Thesis figures: what the thesis itself reports in chapter 4, to be printed beside ours.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

namespace flowdlo::eval {

/// Mean index error (Eq. 4.1) and discrete Frechet distance (Eq. 4.2), cm.
struct ErrorPair {
  double index_cm = 0;
  double frechet_cm = 0;
};

/// One scenario group of Tables 4.2, 4.4, 4.6 and 4.7; the last row is all 59 scenes.
struct ThesisRow {
  const char* scenario;  ///< as meta.json says it; "all": the overall row
  int scenes;
  // Table 4.2: TrackDLO-init's outputs, and errors where both are valid.
  int valid;
  int no_output;
  int invalid;
  std::optional<ErrorPair> trackdlo;
  std::optional<ErrorPair> paired;
  // Table 4.4.
  ErrorPair prior;
  ErrorPair without_points;
  ErrorPair full;
  // Table 4.6; its first column is `full`.
  ErrorPair residual;
  // Table 4.7.
  double accepted_percent;
  double prediction_cm;
  double hybrid_cm;
};

[[nodiscard]] std::span<const ThesisRow> thesis_rows();

/// nullptr: no group of the thesis has that name.
[[nodiscard]] const ThesisRow* thesis_row(const std::string& scenario);

/// Table 4.5: index error, cm, at 1, 4, 10 and 20 steps, and the Frechet distance at 10.
struct ThesisSweep {
  std::array<double, 4> index_cm;
  double frechet_cm;
};
inline constexpr ThesisSweep kThesisVelocity{{3.325, 3.114, 3.102, 3.104}, 6.749};
inline constexpr ThesisSweep kThesisDirect{{3.567, 3.532, 3.530, 3.525}, 6.924};

/// Table 4.3, three real recordings of 20 frames.
struct ThesisRecording {
  const char* name;
  int frames;
  int valid;
  int invalid;
  int no_output;
  int eligible;  ///< frames with a prior
  // Panel (b), percent of the mask-consistency score.
  std::optional<double> trackdlo_percent;
  std::optional<double> prediction_percent;
  std::optional<double> prior_percent;
};

[[nodiscard]] std::span<const ThesisRecording> thesis_recordings();

}  // namespace flowdlo::eval
