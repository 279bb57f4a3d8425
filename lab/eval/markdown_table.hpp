// MarkdownTable: rows of cells as Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace flowdlo::eval {

class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header);

  /// Cells beyond the header are left out, missing ones are empty.
  void add(std::vector<std::string> cells);

  /// With an empty line after it.
  [[nodiscard]] std::string text() const;

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace flowdlo::eval
