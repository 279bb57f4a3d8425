#include "report/markdown_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::report {
namespace {

using testing::HasSubstr;

TEST(MarkdownHtml, TablesHaveAHeaderAndRows) {
  const std::string html = html_of("| a | b |\n|---|---|\n| 1 | *2* |\n");
  EXPECT_THAT(html, HasSubstr("<tr><th>a</th><th>b</th></tr>"));
  EXPECT_THAT(html, HasSubstr("<tr><td>1</td><td><em>2</em></td></tr>"));
}

TEST(MarkdownHtml, EmptyCellsStayInTheirColumn) {
  EXPECT_THAT(html_of("| a | b |\n|---|---|\n| 1 | |\n"), HasSubstr("<td>1</td><td></td>"));
}

TEST(MarkdownHtml, HeadingsParagraphsAndLists) {
  EXPECT_EQ(html_of("## Head\n\none\ntwo\n\n- a\n- b\n"),
            "<h2>Head</h2>\n<p>one\ntwo\n</p>\n<ul>\n<li>a</li>\n<li>b</li>\n</ul>\n");
}

TEST(MarkdownHtml, TextCannotBecomeMarkup) {
  EXPECT_EQ(html_of("<script>\"&\n"), "<p>&lt;script&gt;&quot;&amp;\n</p>\n");
}

TEST(MarkdownHtml, SingleStarsStay) { EXPECT_EQ(html_of("2 * 3\n"), "<p>2 * 3\n</p>\n"); }

TEST(MarkdownHtml, CodeIsCode) {
  EXPECT_EQ(html_of("`sigma_m`\n"), "<p><code>sigma_m</code>\n</p>\n");
}

}  // namespace
}  // namespace flowdlo::report
