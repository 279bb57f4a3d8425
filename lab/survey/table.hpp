// Table: rows of cells as Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace flowdlo::survey {

class Table {
 public:
  explicit Table(std::vector<std::string> header) : columns_(header.size()) {
    add(std::move(header));
    text_ += "|";
    for (std::size_t i = 0; i < columns_; ++i) text_ += "---|";
    text_ += "\n";
  }

  /// Cells beyond the header are left out, missing ones are empty.
  void add(std::vector<std::string> cells) {
    cells.resize(columns_);
    text_ += "|";
    for (const std::string& cell : cells) text_ += " " + cell + (cell.empty() ? "|" : " |");
    text_ += "\n";
  }

  /// With an empty line after it.
  [[nodiscard]] std::string text() const { return text_ + "\n"; }

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace flowdlo::survey
