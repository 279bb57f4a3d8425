// Panels: lines over a common axis, several panels on a page, as PNG.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::pictures {

struct Line {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool dashed = false;
};

struct Panel {
  std::string title;
  std::string x_name;
  bool logarithmic = false;    ///< the upward axis
  bool logarithmic_x = false;  ///< the axis to the right
  bool from_zero = false;      ///< the upward axis begins there; not with a logarithmic one
  bool marked = false;         ///< a dot at every point, with its value on the last
  std::vector<Line> lines;
};

/// Two panels in a row. Written under a temporary name, then renamed. Fails with kIo.
[[nodiscard]] Result<void> save_panels(std::span<const Panel> panels,
                                       const std::filesystem::path& file);

}  // namespace flowdlo::pictures
