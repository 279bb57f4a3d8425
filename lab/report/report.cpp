#include "report/report.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "report/base64.hpp"
#include "report/markdown_html.hpp"
#include "report/page_parts.hpp"
#include "report/scene_json.hpp"

namespace flowdlo::report {
namespace {

std::string figures_html(std::span<const eval::Figure> figures) {
  std::string html;
  for (const eval::Figure& figure : figures) {
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption>"
        "</figure>\n",
        escaped(figure.title), base64(figure.png));
  }
  return html;
}

// Each "@NAME@" of the template by its text; what the texts hold is not looked at again.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& parts) {
  std::string result;
  while (!page.empty()) {
    std::size_t first = page.size();
    const std::pair<std::string_view, std::string>* next = nullptr;
    for (const auto& part : parts) {
      if (const std::size_t at = page.find(part.first); at < first) {
        first = at;
        next = &part;
      }
    }
    result += page.substr(0, first);
    if (next == nullptr) return result;
    result += next->second;
    page.remove_prefix(first + next->first.size());
  }
  return result;
}

}  // namespace

std::string report_html(std::span<const eval::Trial> trials, const std::string& results,
                        std::span<const eval::Figure> figures) {
  const std::size_t head = std::min(results.find("\n## "), results.size());  // before the tables
  return filled(page_template(), {{"@HEAD@", html_of(results.substr(0, head))},
                                  {"@FIGURES@", figures_html(figures)},
                                  {"@TABLES@", html_of(results.substr(head))},
                                  {"@LICENSE@", escaped(viewer_license())},
                                  {"@SCENES@", scenes_json(trials)},
                                  {"@VIEWER@", viewer_script()}});
}

}  // namespace flowdlo::report
