// MarkdownHtml: the Markdown that results.md is made of, as HTML.
#pragma once

#include <string>
#include <string_view>

namespace flowdlo::report {

/// `text` with &, <, > and quotes as entities.
[[nodiscard]] std::string escaped(std::string_view text);

/// Headings, paragraphs, tables, lists of one level, *emphasis* and `code`; nothing else is known,
/// and what looks like HTML is shown as it stands.
[[nodiscard]] std::string html_of(std::string_view markdown);

}  // namespace flowdlo::report
