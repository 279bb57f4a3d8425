// A centerline as CSV: header x,y,z, then 64 rows in metres, from one end to the other.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "flowdlo/centerline.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// Fails with kBadInput: wrong header, not 64 rows, not three finite numbers in a row. The message
/// begins with `who`, the file's name, and names the line.
[[nodiscard]] Result<Centerline> parse_centerline(std::string_view text, const std::string& who);

/// Nine significant digits, so that parse_centerline gives back the same bits. Of a curve with
/// other than 64 points as many rows.
[[nodiscard]] std::string format_centerline(std::span<const Point3> points);

}  // namespace flowdlo::frame
