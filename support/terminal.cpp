#include "terminal.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include "files/shown_name.hpp"

namespace flowdlo::support {

void say(std::FILE* stream, std::string_view text) {
  const std::string shown = files::shown_lines(text);
  (void)std::fwrite(shown.data(), 1, shown.size(), stream);
}

int finished(std::string_view who, int exit_code) {
  errno = 0;
  const bool lost_now = std::fflush(stdout) != 0;
  const int code = errno;
  if (!lost_now && std::ferror(stdout) == 0) return exit_code;
  tell_error("{}: standard output cannot be written{}; make space, or send it elsewhere\n", who,
             lost_now ? ": " + std::generic_category().message(code) : std::string());
  return exit_code == 0 ? 1 : exit_code;
}

}  // namespace flowdlo::support
