#include "view/shown_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "estimate_json.hpp"
#include "frame_picture.hpp"
#include "overlay.hpp"
#include "png_picture.hpp"

namespace flowdlo::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kCurvePoints = 253;      // four for each stretch between nodes
constexpr double kMostScenery = 6000;  // points of the frame beside the rope
constexpr double kMostOfRope = 6000;

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

Json numbers(const Point3& point) {
  return Json::array({number(static_cast<double>(point.x)), number(static_cast<double>(point.y)),
                      number(static_cast<double>(point.z))});
}

template <class Points>
Json list_of(const Points& points) {
  Json list = Json::array();
  for (const Point3& point : points) list.push_back(numbers(point));
  return list;
}

/// [points, 3] numbers in a row, as Tensors has them.
Json list_of(const float* values, std::size_t points) {
  Json list = Json::array();
  for (std::size_t i = 0; i < points; ++i) {
    list.push_back(numbers({values[3 * i], values[3 * i + 1], values[3 * i + 2]}));
  }
  return list;
}

Json curve_of(const Estimate& rope) {
  const auto curve = rope.curve(kCurvePoints);
  return curve ? list_of(*curve) : list_of(rope.nodes);
}

const char* words_of(Doubt doubt) {
  switch (doubt) {
    case Doubt::kNoRope:
      return "the mask has not the shape of a rope";
    case Doubt::kStrandsLeft:
      return "the nodes leave strands of the mask out";
    case Doubt::kBareGap:
      return "the nodes cross plain background";
    case Doubt::kGoesOn:
      return "depth shows the rope going on where the mask ends";
    case Doubt::kNoDepth:
      return "the rope shows no depth: it is taken to lie on what is seen beside it";
  }
  return "";
}

Json rope_json(const Estimate& rope) {
  Json json{{"source", name_of(rope.source)},
            {"origin", name_of(rope.origin)},
            {"confidence", number(static_cast<double>(rope.confidence))},
            {"mask_agreement", number(static_cast<double>(rope.mask_agreement))},
            {"readings", rope.readings},
            {"closed", rope.closed},
            {"total_ms", number(rope.timings.total_ms)},
            {"doubts", Json::array()},
            {"nodes", list_of(rope.nodes)},
            {"curve", curve_of(rope)},
            {"support", rope.support},
            {"sigma_m", Json::array()},
            {"alternatives", Json::array()}};
  for (const Doubt doubt : rope.one_rope.doubts) json["doubts"].push_back(words_of(doubt));
  for (const float sigma_m : rope.sigma_m) {
    json["sigma_m"].push_back(number(static_cast<double>(sigma_m)));
  }
  for (const auto& other : rope.alternatives) {
    json["alternatives"].push_back(
        {{"score", number(static_cast<double>(other.score))}, {"nodes", list_of(other.nodes)}});
  }
  return json;
}

/// Every pixel with a depth, or so many of them in rows and columns: [x, y, z, "rrggbb"].
Json cloud_of(const Frame& frame, bool of_rope, double most) {
  const auto wanted = [&](std::size_t pixel) {
    return frame.depth_m[pixel] > 0 && std::isfinite(frame.depth_m[pixel]) &&
           (frame.mask[pixel] > 127) == of_rope;
  };
  double count = 0;
  const auto pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) count += wanted(pixel) ? 1 : 0;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(count / most))));
  const auto& camera = frame.intrinsics;
  Json points = Json::array();
  for (int v = step / 2; v < frame.height; v += step) {
    for (int u = step / 2; u < frame.width; u += step) {
      const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                         static_cast<std::size_t>(u);
      if (!wanted(pixel)) continue;
      const auto z = static_cast<double>(frame.depth_m[pixel]);
      std::array<int, 3> bgr{150, 150, 150};
      for (std::size_t c = 0; c < 3 && !frame.color_bgr.empty(); ++c) {
        bgr[c] = frame.color_bgr[3 * pixel + c];
      }
      points.push_back(
          {number((u - static_cast<double>(camera.cx)) * z / static_cast<double>(camera.fx)),
           number((v - static_cast<double>(camera.cy)) * z / static_cast<double>(camera.fy)),
           number(z), fmt::format("{:02x}{:02x}{:02x}", bgr[2], bgr[1], bgr[0])});
    }
  }
  return points;
}

template <class Image>
Result<std::string> png_of(const Image& image) {
  const auto bytes = support::encode_png(image);
  if (!bytes) return bytes.error();
  return std::string(bytes->begin(), bytes->end());
}

Result<ShownFrame> pictures_of(const Frame& frame) {
  ShownFrame shown;
  auto mask = png_of(tools::mask_of(frame));
  if (!mask) return mask.error();
  shown.mask = *std::move(mask);
  if (frame.color_bgr.empty()) {
    shown.image = shown.mask;
    return shown;
  }
  auto image = png_of(tools::colors_of(frame));
  if (!image) return image.error();
  shown.image = *std::move(image);
  return shown;
}

Json head_of(const std::string& name, const Frame& frame) {
  const auto& camera = frame.intrinsics;
  return {{"name", name},
          {"width", frame.width},
          {"height", frame.height},
          {"camera", {number(camera.fx), number(camera.fy), number(camera.cx), number(camera.cy)}},
          {"scenery", cloud_of(frame, false, kMostScenery)},
          {"measured", cloud_of(frame, true, kMostOfRope)}};
}

/// Names may hold any bytes; JSON may not.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void put_tensors(const Tensors& tensors, const Estimate& estimate, Json& scene) {
  scene["path"] = Json::array();
  for (std::size_t i = 0; i + 1 < tensors.path.size(); i += 2) {
    scene["path"].push_back({number(static_cast<double>(tensors.path[i])),
                             number(static_cast<double>(tensors.path[i + 1]))});
  }
  scene["prior"] = list_of(tensors.prior.data(), tensors.prior.size() / 3);
  scene["draws"] = Json::array();
  for (std::size_t d = 0; d < estimate.draws.size(); ++d) {
    const std::size_t begin = d * kNodes * 3;
    if (tensors.prediction.size() < begin + kNodes * 3) break;
    scene["draws"].push_back({{"accepted", estimate.draws[d].accepted},
                              {"nodes", list_of(tensors.prediction.data() + begin, kNodes)}});
  }
}

}  // namespace

Result<ShownFrame> shown_frame(const std::string& name, const Frame& frame, const Seen& seen) {
  auto shown = pictures_of(frame);
  if (!shown) return shown;
  const auto& strands = seen.tensors.strands;
  if (!strands.channels.empty()) {
    auto field = png_of(tools::draw_field(frame, strands));
    if (!field) return field.error();
    shown->field = *std::move(field);
  }
  Json scene = head_of(name, frame);
  scene["device"] = seen.device;
  scene["field"] = !shown->field.empty();
  scene["ropes"] = Json::array();
  for (const Estimate& rope : seen.ropes.ropes) scene["ropes"].push_back(rope_json(rope));
  if (!seen.tensors.prior.empty()) put_tensors(seen.tensors, seen.ropes.ropes.front(), scene);
  shown->scene = text_of(scene);
  return shown;
}

Result<ShownFrame> shown_frame(const std::string& name, const Frame& frame, const Error& error) {
  auto shown = pictures_of(frame);
  if (!shown) return shown;
  Json scene = head_of(name, frame);
  scene["field"] = false;
  scene["ropes"] = Json::array();
  scene["error"] = error.message;
  shown->scene = text_of(scene);
  return shown;
}

ShownFrame shown_failure(const std::string& name, const Error& error) {
  ShownFrame shown;
  shown.scene = text_of({{"name", name}, {"ropes", Json::array()}, {"error", error.message}});
  return shown;
}

}  // namespace flowdlo::view
