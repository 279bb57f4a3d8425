#include "eval/thesis_figures.hpp"

#include <algorithm>

namespace flowdlo::eval {
namespace {

// clang-format off
constexpr std::array<ThesisRow, 10> kRows{{
    {"C", 6, 6, 0, 0, ErrorPair{1.475, 2.133}, ErrorPair{0.301, 0.746},
     {0.926, 1.281}, {0.252, 0.501}, {0.222, 0.463}, {0.213, 0.471}, 100.0, 0.212, 0.212},
    {"S", 6, 5, 1, 0, ErrorPair{1.369, 2.144}, ErrorPair{0.415, 1.181},
     {0.906, 1.179}, {0.287, 0.508}, {0.262, 0.526}, {0.261, 0.496}, 100.0, 0.275, 0.275},
    {"straight", 2, 2, 0, 0, ErrorPair{1.342, 2.081}, ErrorPair{0.350, 0.537},
     {0.937, 1.237}, {0.259, 0.382}, {0.286, 0.381}, {0.265, 0.364}, 100.0, 0.282, 0.282},
    {"intersection", 8, 8, 0, 0, ErrorPair{2.606, 4.490}, ErrorPair{1.348, 2.165},
     {6.615, 8.011}, {2.013, 3.413}, {1.474, 2.092}, {1.267, 2.231}, 62.5, 1.455, 3.147},
    {"C-complicated", 7, 1, 6, 0, ErrorPair{15.724, 35.699}, ErrorPair{1.013, 0.919},
     {0.607, 1.012}, {0.426, 0.760}, {0.472, 1.043}, {1.186, 1.986}, 100.0, 0.494, 0.494},
    {"S-complicated", 8, 2, 6, 0, ErrorPair{6.700, 16.774}, ErrorPair{0.554, 1.220},
     {0.457, 0.948}, {0.469, 0.849}, {0.604, 1.385}, {0.604, 1.187}, 84.4, 0.550, 0.483},
    {"straight-complicated", 2, 0, 2, 0, std::nullopt, std::nullopt,
     {0.640, 0.967}, {16.333, 32.124}, {14.180, 27.751}, {12.359, 24.185}, 50.0, 14.222, 6.490},
    {"intersection-complicated", 8, 6, 0, 2, ErrorPair{18.501, 35.170}, ErrorPair{7.503, 17.975},
     {12.982, 17.027}, {9.245, 17.773}, {8.015, 17.793}, {9.052, 17.680}, 9.4, 7.751, 12.416},
    {"intersection-new", 12, 1, 9, 2, ErrorPair{3.883, 8.434}, ErrorPair{1.374, 2.597},
     {9.873, 13.014}, {5.433, 10.934}, {5.596, 13.209}, {5.827, 12.046}, 14.6, 5.570, 8.863},
    {"all", 59, 31, 24, 4, ErrorPair{5.911, 11.365}, ErrorPair{2.061, 4.599},
     {5.039, 6.615}, {3.363, 6.506}, {3.102, 6.749}, {3.283, 6.477}, 61.4, 3.055, 4.316},
}};

constexpr std::array<ThesisRecording, 4> kRecordings{{
    {"limited depth resolution", 20, 19, 0, 1, 20, 96.1, 28.7, 99.4},
    {"fast tip motion", 20, 19, 0, 1, 20, 96.8, 28.3, 96.2},
    {"motion without visible tips", 20, 13, 6, 1, 15, 90.9, 38.8, 100.0},
    {"overall", 60, 51, 6, 3, 55, std::nullopt, std::nullopt, std::nullopt},
}};
// clang-format on

}  // namespace

std::span<const ThesisRow> thesis_rows() { return kRows; }

const ThesisRow* thesis_row(const std::string& scenario) {
  const auto found = std::find_if(kRows.begin(), kRows.end(),
                                  [&](const ThesisRow& row) { return row.scenario == scenario; });
  return found == kRows.end() ? nullptr : &*found;
}

std::span<const ThesisRecording> thesis_recordings() { return kRecordings; }

}  // namespace flowdlo::eval
