#include "frame/camera_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "frame/faults.hpp"
#include "frame/limits.hpp"
#include "json/parse.hpp"

namespace flowdlo::frame {
namespace {

using json::Value;

constexpr double kMillimetre_m = 0.001;

struct Reader {
  const Value& json;
  const std::string& who;
  Faults& faults;

  [[nodiscard]] bool has(const char* key) const { return json.find(key) != nullptr; }
  void fault(const std::string& text) { faults.bad_input(who + ": " + text); }
};

// What came instead, short enough for a message. Nested values are not written out.
std::string shown(const Value& value) {
  constexpr std::size_t kLongest = 40;
  const auto structured = [](const Value& entry) { return entry.is_structured(); };
  if (std::any_of(value.elements.begin(), value.elements.end(), structured)) {
    return "a nested array";
  }
  if (std::any_of(value.members.begin(), value.members.end(),
                  [&](const json::Member& member) { return structured(member.value); })) {
    return "a nested object";
  }
  std::string text = json::text_of(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

std::optional<double> number(Reader& reader, const char* key) {
  const Value* const found = reader.json.find(key);
  if (found == nullptr) {
    reader.fault(fmt::format("\"{}\" is missing; add it", key));
    return std::nullopt;
  }
  if (!found->is_number()) {
    reader.fault(fmt::format("\"{}\": expected a number, got {}", key, shown(*found)));
    return std::nullopt;
  }
  return found->number;
}

int side(Reader& reader, const char* key) {
  const auto value = number(reader, key);
  if (!value) return 0;
  if (*value >= 1 && *value <= kMaxSide_px && *value == std::floor(*value)) {
    return static_cast<int>(*value);
  }
  reader.fault(fmt::format("\"{}\": expected a whole number from 1 to {}, got {}", key, kMaxSide_px,
                           shown(*reader.json.find(key))));
  return 0;
}

void check_focal_length(Reader& reader, const char* name, double focal_px) {
  if (focal_px >= kMinFocal_px && focal_px <= kMaxFocal_px) return;
  reader.fault(fmt::format("{}: expected a focal length of {} to {} px, got {}", name, kMinFocal_px,
                           kMaxFocal_px, focal_px));
}

void check_center(Reader& reader, const char* name, double center_px) {
  if (std::abs(center_px) <= kMaxFocal_px) return;
  reader.fault(fmt::format("{}: expected a principal point within {} px, got {}", name,
                           kMaxFocal_px, center_px));
}

double depth_scale(Reader& reader, double unit_m, const char* unit) {
  const auto value = number(reader, "depth_scale");
  if (!value) return 0;
  const double scale_m = *value * unit_m;
  if (scale_m > 0 && scale_m <= kMaxDepthScale_m) return scale_m;
  reader.fault(
      fmt::format("\"depth_scale\": expected {} a unit, over 0 and at most {}, got {}; {} "
                  "means a depth.png in millimetres",
                  unit, kMaxDepthScale_m / unit_m, *value, kMillimetre_m / unit_m));
  return 0;
}

// Row-major [fx 0 cx; 0 fy cy; 0 0 1]. The zeros are checked: a transposed or skewed matrix would
// otherwise give a wrong curve without a word.
Intrinsics from_matrix(Reader& reader, const char* key, bool column_major) {
  const Value& value = *reader.json.find(key);
  const auto& entries = value.elements;  // none where it is no array
  const bool nine_numbers =
      entries.size() == 9 && std::all_of(entries.begin(), entries.end(),
                                         [](const Value& entry) { return entry.is_number(); });
  if (!nine_numbers) {
    reader.fault(fmt::format("\"{}\": expected 9 numbers, got {}", key, shown(value)));
    return {};
  }
  std::array<double, 9> k{};
  for (std::size_t i = 0; i < 9; ++i) {
    k[i] = entries[column_major ? (i % 3) * 3 + i / 3 : i].number;
  }
  const double tolerance = 1e-6 * std::abs(k[0]);
  if (std::abs(k[1]) > tolerance || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    reader.fault(fmt::format(
        "\"{}\": expected [fx 0 cx; 0 fy cy; 0 0 1] in {} order, got {}; transpose it, or rectify "
        "the images where it has skew",
        key, column_major ? "column-major" : "row-major", shown(value)));
    return {};
  }
  check_focal_length(reader, "fx", k[0]);
  check_focal_length(reader, "fy", k[4]);
  check_center(reader, "cx", k[2]);
  check_center(reader, "cy", k[5]);
  return {static_cast<float>(k[0]), static_cast<float>(k[4]), static_cast<float>(k[2]),
          static_cast<float>(k[5])};
}

Intrinsics from_fields(Reader& reader) {
  const auto fx = number(reader, "fx");
  const auto fy = number(reader, "fy");
  const auto cx = number(reader, "cx");
  const auto cy = number(reader, "cy");
  if (fx) check_focal_length(reader, "\"fx\"", *fx);
  if (fy) check_focal_length(reader, "\"fy\"", *fy);
  if (cx) check_center(reader, "\"cx\"", *cx);
  if (cy) check_center(reader, "\"cy\"", *cy);
  return {static_cast<float>(fx.value_or(0)), static_cast<float>(fy.value_or(0)),
          static_cast<float>(cx.value_or(0)), static_cast<float>(cy.value_or(0))};
}

CameraFile read_own(Reader& reader) {
  CameraFile camera{side(reader, "width"), side(reader, "height"), from_fields(reader), 0};
  camera.depth_scale_m = depth_scale(reader, 1.0, "metres");
  return camera;
}

CameraFile read_bop(Reader& reader) {
  CameraFile camera;
  if (reader.has("width")) camera.width = side(reader, "width");
  if (reader.has("height")) camera.height = side(reader, "height");
  camera.intrinsics = from_matrix(reader, "cam_K", /*column_major=*/false);
  camera.depth_scale_m = depth_scale(reader, kMillimetre_m, "millimetres");
  return camera;
}

CameraFile read_open3d(Reader& reader) {
  CameraFile camera{side(reader, "width"), side(reader, "height"),
                    from_matrix(reader, "intrinsic_matrix", /*column_major=*/true),
                    kOpen3dDepthScale_m};
  if (reader.has("depth_scale")) {
    camera.depth_scale_m = depth_scale(reader, 1.0, "metres");
  }
  return camera;
}

/// Whether it is, or holds, a number that is not 0.
bool distorts(const Value& value) {
  if (value.is_number()) return value.number != 0;
  return std::any_of(value.elements.begin(), value.elements.end(), distorts);
}

/// Nothing here takes a lens' distortion back: nodes would be off without a word.
void check_rectified(Reader& reader) {
  for (const char* key : {"D", "distortion", "distortion_coefficients", "dist_coeffs", "distCoeffs",
                          "k1", "k2", "k3", "p1", "p2"}) {
    const Value* value = reader.json.find(key);
    if (value == nullptr || !distorts(*value)) continue;
    reader.fault(
        fmt::format("\"{}\": expected rectified images, without distortion, got {}; rectify "
                    "them and leave it out",
                    key, shown(*value)));
  }
}

CameraFile read_form(Reader& reader) {
  if (!reader.json.is_object()) {
    reader.fault("expected a JSON object, got " + shown(reader.json));
    return {};
  }
  check_rectified(reader);
  const bool own = reader.has("fx") || reader.has("fy");
  const bool bop = reader.has("cam_K");
  const bool open3d = reader.has("intrinsic_matrix");
  if (int{own} + int{bop} + int{open3d} > 1) {
    reader.fault(
        "expected one of fx/fy/cx/cy, cam_K and intrinsic_matrix, got several, whose depth scales "
        "differ in unit; keep one");
    return {};
  }
  if (bop) return read_bop(reader);
  if (open3d) return read_open3d(reader);
  return read_own(reader);
}

std::string syntax_fault(std::string_view text, std::size_t byte) {
  const auto before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  return fmt::format(
      "expected JSON, got something else in line {} (numbers must be finite: JSON "
      "has no NaN and no Infinity); write it again",
      line);
}

}  // namespace

Result<CameraFile> parse_camera(std::string_view text, const std::string& who) {
  const json::Parsed parsed = json::parse(text);
  if (parsed.too_large) {
    return Error{ErrorCode::kBadInput, who + ": a number is too large; write it again"};
  }
  if (!parsed.fine) {
    return Error{ErrorCode::kBadInput, who + ": " + syntax_fault(text, parsed.fault_at)};
  }
  Faults faults;
  Reader reader{parsed.value, who, faults};
  for (const std::string& key : parsed.twice) {
    reader.fault(fmt::format("{} is given twice; keep one", json::escaped(key)));
  }
  const CameraFile camera = read_form(reader);
  if (!faults.empty()) return faults.error();
  return camera;
}

std::string format_camera(const CameraFile& camera) {
  return fmt::format(
      "{{\n  \"width\": {},\n  \"height\": {},\n  \"fx\": {:.9g},\n  \"fy\": {:.9g},\n"
      "  \"cx\": {:.9g},\n  \"cy\": {:.9g},\n  \"depth_scale\": {:.17g}\n}}\n",
      camera.width, camera.height, camera.intrinsics.fx, camera.intrinsics.fy, camera.intrinsics.cx,
      camera.intrinsics.cy, camera.depth_scale_m);
}

}  // namespace flowdlo::frame
