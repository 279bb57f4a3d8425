#include "eval/markdown_table.hpp"

#include <utility>

namespace flowdlo::eval {

MarkdownTable::MarkdownTable(std::vector<std::string> header) : columns_(header.size()) {
  add(std::move(header));
  text_ += "|";
  for (std::size_t i = 0; i < columns_; ++i) text_ += "---|";
  text_ += "\n";
}

void MarkdownTable::add(std::vector<std::string> cells) {
  cells.resize(columns_);
  text_ += "|";
  for (const std::string& cell : cells) text_ += " " + cell + (cell.empty() ? "|" : " |");
  text_ += "\n";
}

std::string MarkdownTable::text() const { return text_ + "\n"; }

}  // namespace flowdlo::eval
