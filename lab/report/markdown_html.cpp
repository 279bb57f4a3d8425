#include "report/markdown_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flowdlo::report {
namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string element(const std::string& name, const std::string& content) {
  return fmt::format("<{0}>{1}</{0}>", name, content);
}

// A pair of `mark` becomes an element; a single one stays.
std::string paired(const std::string& text, char mark, const char* name) {
  std::string result;
  std::size_t at = 0;
  for (;;) {
    const std::size_t open = text.find(mark, at);
    const std::size_t close = open == std::string::npos ? open : text.find(mark, open + 1);
    if (close == std::string::npos) return result + text.substr(at);
    result += text.substr(at, open - at);
    result += element(name, text.substr(open + 1, close - open - 1));
    at = close + 1;
  }
}

std::string inline_html(std::string_view text) {
  return paired(paired(escaped(text), '*', "em"), '`', "code");
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  line.remove_prefix(1);  // the first bar
  while (!line.empty()) {
    const std::size_t end = std::min(line.find('|'), line.size());
    std::string_view cell = line.substr(0, end);
    while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
    while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
    cells.push_back(cell);
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return cells;
}

std::string row_html(std::string_view line, const char* cell_name) {
  std::string row;
  for (const std::string_view cell : cells_of(line)) row += element(cell_name, inline_html(cell));
  return element("tr", row) + "\n";
}

bool is_heading(std::string_view line) {
  const std::size_t depth = line.find_first_not_of('#');
  return depth != std::string_view::npos && depth >= 1 && depth <= 6 && line[depth] == ' ';
}

bool is_item(std::string_view line) { return line.starts_with("- "); }
bool is_row(std::string_view line) { return line.starts_with("|"); }

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string html_of(std::string_view markdown) {
  const auto lines = lines_of(markdown);
  std::string html;
  for (std::size_t i = 0; i < lines.size();) {
    if (lines[i].empty()) {
      ++i;
    } else if (is_heading(lines[i])) {
      const std::size_t depth = lines[i].find_first_not_of('#');
      html += element(fmt::format("h{}", depth), inline_html(lines[i++].substr(depth + 1))) + "\n";
    } else if (is_row(lines[i])) {
      html += "<div class=\"table\"><table>\n" + row_html(lines[i++], "th");
      if (i < lines.size() && lines[i].starts_with("|--")) ++i;
      while (i < lines.size() && is_row(lines[i])) html += row_html(lines[i++], "td");
      html += "</table></div>\n";
    } else if (is_item(lines[i])) {
      html += "<ul>\n";
      while (i < lines.size() && is_item(lines[i])) {
        html += element("li", inline_html(lines[i++].substr(2))) + "\n";
      }
      html += "</ul>\n";
    } else {
      html += "<p>";
      while (i < lines.size() && !lines[i].empty() && !is_row(lines[i]) && !is_heading(lines[i]) &&
             !is_item(lines[i])) {
        html += inline_html(lines[i++]) + "\n";
      }
      html += "</p>\n";
    }
  }
  return html;
}

}  // namespace flowdlo::report
