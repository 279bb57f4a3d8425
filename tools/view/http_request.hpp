// HttpRequest: the head of an HTTP/1.1 request as a local page sends it. Whatever else comes is
// refused by its status code: sizes are bounded, bodies and unknown methods are not taken.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace flowdlo::view {

inline constexpr std::size_t kMostHeadBytes = 8192;
inline constexpr std::size_t kMostTargetBytes = 512;
inline constexpr std::size_t kMostHeaders = 64;

struct HttpRequest {
  std::string method;  ///< GET or HEAD
  std::string target;  ///< begins with '/', printable, without spaces
  std::string host;    ///< what the client believes to talk to; empty: it did not say
};

/// What has been received so far.
struct ReadRequest {
  std::optional<HttpRequest> request{};  ///< the whole head is there, and is in order
  int refused = 0;                       ///< status code; 0: not refused
};

/// Neither of both: more has to come. `bytes` begin with the request; what follows its head is not
/// looked at.
[[nodiscard]] ReadRequest read_request(std::string_view bytes);

}  // namespace flowdlo::view
