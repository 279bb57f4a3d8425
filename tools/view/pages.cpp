#include "view/pages.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

namespace flowdlo::view {
namespace {

constexpr std::size_t kKept = 4;  // frames, so that going back and forth costs nothing
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kScript = "text/javascript; charset=utf-8";
constexpr const char* kJson = "application/json";
constexpr const char* kPng = "image/png";
constexpr int kNotFound = 404;

HttpResponse picture(const std::string& png) {
  return png.empty() ? refusal(kNotFound) : HttpResponse{200, kPng, png};
}

}  // namespace

std::string secret() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<long>(bytes.size())) {
    std::random_device source;
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(source());
  }
  std::string text;
  for (const auto byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

Pages::Pages(const std::string& secret, std::vector<std::string> names, Show show)
    : prefix_(fmt::format("/{}/", secret)), frames_(names.size()), show_(std::move(show)) {
  list_ = nlohmann::json(names).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

const ShownFrame& Pages::shown(std::size_t frame) {
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const auto& one) { return one.first == frame; });
  if (known != kept_.end()) return known->second;
  kept_.emplace_front(frame, show_(frame));
  if (kept_.size() > kKept) kept_.pop_back();
  return kept_.front().second;
}

HttpResponse Pages::part_of_frame(std::string_view rest) {
  std::size_t frame = 0;
  const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), frame);
  if (fault != std::errc{} || frame >= frames_) return refusal(kNotFound);
  const std::string_view part(end, static_cast<std::size_t>(rest.data() + rest.size() - end));
  if (part == "/scene.json") return {200, kJson, shown(frame).scene};
  if (part == "/image.png") return picture(shown(frame).image);
  if (part == "/mask.png") return picture(shown(frame).mask);
  if (part == "/field.png") return picture(shown(frame).field);
  return refusal(kNotFound);
}

HttpResponse Pages::response(const HttpRequest& request) {
  std::string_view rest = request.target;
  if (!rest.starts_with(prefix_)) return refusal(kNotFound);
  rest.remove_prefix(prefix_.size());
  constexpr std::string_view kFrames = "frames/";
  if (rest.empty()) return {200, kHtml, page_text()};
  if (rest == "view.js") return {200, kScript, script_text()};
  if (rest == "frames.json") return {200, kJson, list_};
  if (!rest.starts_with(kFrames)) return refusal(kNotFound);
  return part_of_frame(rest.substr(kFrames.size()));
}

}  // namespace flowdlo::view
