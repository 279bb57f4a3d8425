#include "view/http_request.hpp"

#include <algorithm>
#include <cctype>

namespace flowdlo::view {
namespace {

constexpr int kBadRequest = 400;
constexpr int kNotAllowed = 405;
constexpr int kTooLarge = 413;
constexpr int kTargetTooLong = 414;
constexpr int kHeadTooLarge = 431;
constexpr int kNotSupported = 505;

ReadRequest refused(int status) { return {.refused = status}; }

bool is_token(std::string_view text) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char letter) {
    return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
           (letter >= 'A' && letter <= 'Z') || kMarks.find(letter) != std::string_view::npos;
  });
}

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

/// A header's value may hold any byte but control characters.
bool is_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return byte == '\t' || (byte >= ' ' && byte != 0x7f);
  });
}

std::string lowered(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return result;
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Takes the text before the first `mark` off `rest`; all of it where there is none.
std::string_view taken(std::string_view& rest, std::string_view mark) {
  const auto at = rest.find(mark);
  const auto piece = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + mark.size());
  return piece;
}

/// Status code of what is wrong with the first line; 0: nothing.
int read_first_line(std::string_view line, HttpRequest& request) {
  const auto method = taken(line, " ");
  const auto target = taken(line, " ");
  if (!is_token(method) || target.empty() || !is_printable(target)) return kBadRequest;
  if (!line.starts_with("HTTP/") || !is_printable(line)) return kBadRequest;
  if (line != "HTTP/1.1" && line != "HTTP/1.0") return kNotSupported;
  if (method != "GET" && method != "HEAD") return kNotAllowed;
  if (target.size() > kMostTargetBytes) return kTargetTooLong;
  if (target.front() != '/') return kBadRequest;
  request.method = method;
  request.target = target;
  return 0;
}

/// The same of one header.
int read_header(std::string_view line, HttpRequest& request, bool& has_host) {
  const auto colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return kBadRequest;
  const std::string name = lowered(line.substr(0, colon));
  const auto value = trimmed(line.substr(colon + 1));
  if (!is_value(value)) return kBadRequest;
  if (name == "transfer-encoding") return kTooLarge;
  if (name == "content-length" && value != "0") return kTooLarge;
  if (name == "host") {
    if (has_host || !is_printable(value)) return kBadRequest;
    has_host = true;
    request.host = lowered(value);
  }
  return 0;
}

}  // namespace

ReadRequest read_request(std::string_view bytes) {
  const auto end = bytes.substr(0, kMostHeadBytes).find("\r\n\r\n");
  if (end == std::string_view::npos) {
    if (bytes.size() >= kMostHeadBytes) return refused(kHeadTooLarge);
    const bool text = std::all_of(bytes.begin(), bytes.end(), [](char letter) {
      return letter == '\r' || letter == '\n' || is_value({&letter, 1});
    });
    return text ? ReadRequest{} : refused(kBadRequest);  // no need to wait for the rest of it
  }
  auto rest = bytes.substr(0, end);
  HttpRequest request;
  if (const int status = read_first_line(taken(rest, "\r\n"), request); status != 0) {
    return refused(status);
  }
  bool has_host = false;
  for (std::size_t headers = 0; !rest.empty(); ++headers) {
    if (headers == kMostHeaders) return refused(kHeadTooLarge);
    if (const int status = read_header(taken(rest, "\r\n"), request, has_host); status != 0) {
      return refused(status);
    }
  }
  return {.request = std::move(request)};
}

}  // namespace flowdlo::view
