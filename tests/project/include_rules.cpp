#include "project/include_rules.hpp"

#include <regex>

#include "project/tree.hpp"

namespace flowdlo::project {
namespace {

std::string room_of(const std::string& path) { return path.substr(0, path.find('/')); }

bool is_vulkan_header(const std::string& target) {
  static const std::regex pattern(
      R"((vulkan/(vulkan|vk_)[^/]*\.(h|hpp)|(.*/)?volk\.h|vk_video/.*))");
  return std::regex_match(target, pattern);
}

}  // namespace

Rooms parse_rooms(std::string_view markdown) {
  static const std::regex row(R"(\|\s*([0-9]+)\s*\|\s*`([a-z_]+)`\s*\|.*)");
  Rooms rooms;
  for (const auto& line : lines_of(markdown)) {
    if (std::smatch match; std::regex_match(line, match, row)) {
      rooms[match[2]] = std::stoi(match[1]);
    }
  }
  return rooms;
}

std::vector<Include> includes_of(std::string_view source) {
  static const std::regex pattern(R"re(\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  std::vector<Include> includes;
  for (const auto& line : lines_of(source)) {
    if (std::smatch match; std::regex_match(line, match, pattern)) {
      includes.push_back({match[2], match[1] == "<"});
    }
  }
  return includes;
}

std::string complaint(const Rooms& rooms, const std::string& file, const Include& include) {
  const auto from = rooms.find(room_of(file));
  if (from == rooms.end()) {
    return file + ": expected a room of engine/README.md's table, got \"" + room_of(file) + "\"";
  }
  if (include.angled && is_vulkan_header(include.target) && from->first != "vulkan") {
    return file + ": includes <" + include.target + ">; Vulkan headers only in engine/vulkan";
  }
  if (include.target == "flowdlo/vulkan.hpp" && from->first != "vulkan") {
    return file + ": includes \"" + include.target +
           "\", which sees Vulkan; only engine/vulkan may";
  }
  if (include.target.starts_with("../") && !include.target.starts_with("../../shaders/")) {
    return file + ": includes \"" + include.target + "\"; write it from engine/";
  }
  const auto to = rooms.find(room_of(include.target));
  const bool names_a_room = include.target.find('/') != std::string::npos && to != rooms.end();
  if (include.angled || !names_a_room || to == from || to->second > from->second) {
    return {};
  }
  return file + ": includes \"" + include.target + "\", but " + to->first + " (layer " +
         std::to_string(to->second) + ") is not below " + from->first + " (layer " +
         std::to_string(from->second) + ")";
}

}  // namespace flowdlo::project
