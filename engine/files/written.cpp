#include "files/written.hpp"

#include <cerrno>

#include "files/uninterrupted.hpp"

namespace flowdlo::files {
namespace {

template <class Retry>
int written(int file, std::span<const std::uint8_t> bytes, const SystemCalls& calls,
            const Retry& retry) {
  while (!bytes.empty()) {
    const auto count = uninterrupted([&] { return calls.write(file, bytes.data(), bytes.size()); });
    if (count < 0 && retry(errno)) continue;
    if (count < 0) return errno;
    if (count == 0) return EIO;  // nothing taken and nothing said: it would be so for ever
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace

int written(int file, std::span<const std::uint8_t> bytes, const SystemCalls& calls) {
  return written(file, bytes, calls, [](int) { return false; });
}

int written_when_ready(int file, std::span<const std::uint8_t> bytes, const SystemCalls& calls) {
  return written(file, bytes, calls, [&](int code) {
    if (code != EAGAIN) return false;
    const bool ready = uninterrupted([&] { return calls.await_writable(file, kPatience_ms); }) > 0;
    errno = EAGAIN;
    return ready;
  });
}

}  // namespace flowdlo::files
