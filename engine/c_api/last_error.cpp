#include "c_api/last_error.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

namespace flowdlo::c_api {
namespace {

constexpr std::size_t kMostBytes = 4095;

// Neither allocates nor has a destructor: both could fail where memory has run out.
thread_local char message_of_thread[kMostBytes + 1] = {};

/// Bytes of `text` that fit, whole characters of UTF-8.
std::size_t fitting(const std::string& text) {
  if (text.size() <= kMostBytes) return text.size();
  std::size_t size = kMostBytes;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size;
}

}  // namespace

flowdlo_status told(const Result<void>& result) noexcept {
  if (result) return FLOWDLO_OK;
  const std::string& message = result.error().message;
  const std::size_t size = fitting(message);
  std::memcpy(message_of_thread, message.data(), size);
  message_of_thread[size] = '\0';
  return status_of(result.error().code);
}

const char* last_error() noexcept { return message_of_thread; }

}  // namespace flowdlo::c_api
