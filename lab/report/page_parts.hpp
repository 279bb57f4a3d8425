// PageParts: the texts of report.html that do not depend on an evaluation; compiled in.
#pragma once

#include <string>

namespace flowdlo::report {

[[nodiscard]] std::string page_template();   ///< page.html
[[nodiscard]] std::string viewer_script();   ///< viewer/viewer.min.js
[[nodiscard]] std::string viewer_license();  ///< viewer/LICENSE.three

}  // namespace flowdlo::report
