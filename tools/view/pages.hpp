// Pages: what is served of which address. Every address begins with a secret, which the printed
// link carries: other users of this computer can reach the port, and other sites' pages as well.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "view/http_server.hpp"
#include "view/shown_frame.hpp"

namespace flowdlo::view {

/// 32 hexadecimal digits from the system's random source.
[[nodiscard]] std::string secret();

/// The page and its script, as they are served.
[[nodiscard]] std::string page_text();
[[nodiscard]] std::string script_text();

class Pages {
 public:
  using Show = std::function<ShownFrame(std::size_t frame)>;

  /// `show` is called for a frame that is asked for, once as long as it is kept.
  Pages(const std::string& secret, std::vector<std::string> names, Show show);

  /// "/SECRET/", "/SECRET/view.js", "/SECRET/frames.json", "/SECRET/frames/N/scene.json",
  /// "image.png", "mask.png" and "field.png" there; 404 for anything else.
  [[nodiscard]] HttpResponse response(const HttpRequest& request);

 private:
  [[nodiscard]] const ShownFrame& shown(std::size_t frame);
  [[nodiscard]] HttpResponse part_of_frame(std::string_view rest);

  std::string prefix_;
  std::string list_;  // frames.json
  std::size_t frames_;
  Show show_;
  std::deque<std::pair<std::size_t, ShownFrame>> kept_;  // the latest first
};

}  // namespace flowdlo::view
