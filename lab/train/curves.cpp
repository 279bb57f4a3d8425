// Curves: the log's columns, four panels on one page.
#include "train/curves.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "pictures/panels.hpp"

namespace flowdlo::train {
namespace {

using pictures::Line;
using pictures::Panel;
using Row = std::map<std::string, std::string>;

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::vector<std::string> names;
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    std::vector<std::string> cells;
    std::stringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    if (cells.size() != names.size()) continue;
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

double number(const Row& row, const std::string& name) {
  const auto found = row.find(name);
  return found == row.end() ? 0.0 : std::atof(found->second.c_str());
}

/// One column over the steps, averaged so that a few hundred points remain.
Line column(const std::vector<Row>& rows, const std::string& name) {
  constexpr std::size_t kMost = 400;
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / kMost);
  Line line{name, {}, {}};
  for (std::size_t first = 0; first + stride <= rows.size(); first += stride) {
    double sum = 0;
    for (std::size_t i = first; i < first + stride; ++i) sum += number(rows[i], name);
    line.x.push_back(number(rows[first + stride - 1], "step"));
    line.y.push_back(sum / static_cast<double>(stride));
  }
  return line;
}

Line group_line(const std::vector<Row>& rows, const std::string& group, const std::string& name,
                bool dashed) {
  Line line{group + " " + name, {}, {}, dashed};
  for (const Row& row : rows) {
    if (row.at("group") != group) continue;
    line.x.push_back(number(row, "step"));
    line.y.push_back(number(row, name));
  }
  return line;
}

}  // namespace

Result<void> plot_curves(const std::filesystem::path& folder) {
  const auto steps = read_rows(folder / "steps.csv");
  const auto checks = read_rows(folder / "validation.csv");
  std::vector<Panel> panels(4);
  for (Panel& panel : panels) panel.x_name = "step";
  panels[0].title = "training losses";
  panels[0].logarithmic = true;
  panels[0].lines = {column(steps, "primary"), column(steps, "prior"), column(steps, "harm")};
  panels[1].title = "shape and sigma terms";
  panels[1].lines = {column(steps, "spacing"), column(steps, "sigma")};
  panels[2].title = "validation: mean index error, cm (prior dashed)";
  panels[3].title = "validation: model / prior";
  for (const char* group : {"all", "easy", "hard"}) {
    panels[2].lines.push_back(group_line(checks, group, "model_cm", false));
    panels[2].lines.push_back(group_line(checks, group, "prior_cm", true));
    panels[3].lines.push_back(group_line(checks, group, "ratio", false));
  }
  return pictures::save_panels(panels, folder / "curves.png");
}

}  // namespace flowdlo::train
