#include "video_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/shown_name.hpp"
#include "image/resize.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
using support::Picture;

constexpr const char* kProgram = "ffmpeg";
constexpr std::size_t kMostWords = 2000;  // of what ffmpeg says

/// A file descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }

  [[nodiscard]] int number() const { return number_; }
  void close() { Descriptor(std::exchange(number_, -1)); }

 private:
  int number_;
};

/// Starts ffmpeg with `in` as its standard input and `out` as all that it prints to. 0, or what
/// went wrong.
int start(std::vector<std::string> arguments, int in, int out, pid_t& process) {
  std::vector<char*> list;
  for (auto& argument : arguments) list.push_back(argument.data());
  list.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (in >= 0) {
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDERR_FILENO);
  const int fault = ::posix_spawnp(&process, kProgram, &actions, nullptr, list.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return fault;
}

/// The exit code; -1: a signal ended it.
int ended(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string words_in(int file) {
  std::string words(kMostWords, '\0');
  const auto size = ::pread(file, words.data(), words.size(), 0);
  words.resize(static_cast<std::size_t>(std::max<ssize_t>(0, size)));
  while (!words.empty() && words.back() == '\n') words.pop_back();
  return words;
}

Error without_ffmpeg(const std::string& why) {
  return {ErrorCode::kIo,
          fmt::format("--video: expected the program ffmpeg, which encodes it, got {}; install it "
                      "(Debian and Ubuntu: ffmpeg), or leave --video out",
                      why)};
}

image::Size even(const image::Size& size) {
  return {size.width + size.width % 2, size.height + size.height % 2};
}

/// Each pixel the mean of what lies under it.
Picture scaled(const Picture& picture, const image::Size& size) {
  using Three = std::array<float, 3>;
  image::Image<Three> values(picture.size());
  for (int v = 0; v < picture.height(); ++v) {
    std::transform(picture.row(v), picture.row(v) + picture.width(), values.row(v),
                   [](const support::Color& color) {
                     return Three{static_cast<float>(color[0]), static_cast<float>(color[1]),
                                  static_cast<float>(color[2])};
                   });
  }
  const auto means = image::area_mean<Three>(values, size);
  const auto byte_of = [](float value) {
    return static_cast<std::uint8_t>(std::clamp(std::lrint(value), 0L, 255L));
  };
  Picture result(size);
  for (int v = 0; v < result.height(); ++v) {
    std::transform(means.row(v), means.row(v) + result.width(), result.row(v),
                   [&](const Three& mean) {
                     return support::Color{byte_of(mean[0]), byte_of(mean[1]), byte_of(mean[2])};
                   });
  }
  return result;
}

/// In the middle of a picture of that size, as large as it fits; a pixel more is black.
Picture fitted(const Picture& picture, const image::Size& size) {
  const bool packed = picture.stride() == picture.width();
  if (picture.size() == size && packed) return picture;
  Picture fitting = picture;
  if (even(picture.size()) != size) {
    const double zoom = std::min(static_cast<double>(size.width) / picture.width(),
                                 static_cast<double>(size.height) / picture.height());
    const auto side = [zoom](int given, int most) {
      return std::clamp(static_cast<int>(std::lrint(zoom * given)), 1, most);
    };
    fitting =
        scaled(picture, {side(picture.width(), size.width), side(picture.height(), size.height)});
  }
  Picture whole(size, support::Color{});
  Picture middle =
      whole.part({(size.width - fitting.width()) / 2, (size.height - fitting.height()) / 2,
                  fitting.width(), fitting.height()});
  for (int v = 0; v < fitting.height(); ++v) {
    std::copy_n(fitting.row(v), fitting.width(), middle.row(v));
  }
  return whole;
}

}  // namespace

struct VideoFile::Encoder {
  fs::path file;
  fs::path partial;
  double frames_per_s = 0;
  image::Size size{};
  Descriptor pictures{};  // ffmpeg's standard input
  Descriptor words{};     // what it prints
  pid_t process = -1;
  std::optional<Error> fault{};

  Encoder(fs::path its_file, double rate) : file(std::move(its_file)), frames_per_s(rate) {}
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { drop(); }

  /// Leaves nothing behind, unless the file has got its name.
  void drop() {
    if (process > 0) {
      ::kill(process, SIGKILL);
      ended(std::exchange(process, -1));
    }
    std::error_code ignored;
    if (!partial.empty()) fs::remove(std::exchange(partial, {}), ignored);
  }

  [[nodiscard]] Error failed(const std::string& why) const {
    return {ErrorCode::kIo, fmt::format("--video {}: {}", files::shown(file), why)};
  }

  [[nodiscard]] Result<void> make_partial();
  void begin(const image::Size& first);
  void send(const Picture& picture);
  [[nodiscard]] Result<void> finish();
};

/// Beside the file that it becomes, under a name that nobody else knows or has taken.
Result<void> VideoFile::Encoder::make_partial() {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof(bits), 0) != sizeof(bits)) return failed(std::strerror(errno));
  auto name = file;
  name.replace_filename(fmt::format(".{}.{:016x}.partial", file.filename().string(), bits));
  const Descriptor made(
      ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (made.number() < 0) return failed(std::strerror(errno));
  partial = name;
  return {};
}

void VideoFile::Encoder::begin(const image::Size& first) {
  size = even(first);
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    fault = failed(std::strerror(errno));
    return;
  }
  pictures = Descriptor(ends[0]);
  const Descriptor theirs(ends[1]);
  // "file:" keeps ffmpeg from taking a name for an option or an address.
  const int code = start({kProgram,
                          "-hide_banner",
                          "-loglevel",
                          "error",
                          "-nostdin",
                          "-y",  //
                          "-f",
                          "rawvideo",
                          "-pixel_format",
                          "bgr24",
                          "-video_size",
                          fmt::format("{}x{}", size.width, size.height),
                          "-framerate",
                          fmt::format("{}", frames_per_s),
                          "-i",
                          "pipe:0",  //
                          "-pix_fmt",
                          "yuv420p",
                          "-movflags",
                          "+faststart",
                          "-f",
                          "mp4",
                          "file:" + partial.string()},
                         theirs.number(), words.number(), process);
  if (code != 0) fault = without_ffmpeg(std::strerror(code));
}

/// Through a socket, for a pipe that nobody reads any more would end the process.
void VideoFile::Encoder::send(const Picture& picture) {
  const auto* bytes = reinterpret_cast<const char*>(picture.data());
  std::size_t left = picture.total() * sizeof(support::Color);
  while (left > 0) {
    const auto sent = ::send(pictures.number(), bytes, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) {
      pictures.close();
      const int code = ended(std::exchange(process, -1));
      fault = failed(fmt::format("ffmpeg ended with {}: {}", code, words_in(words.number())));
      return;
    }
    bytes += sent;
    left -= static_cast<std::size_t>(sent);
  }
}

Result<void> VideoFile::Encoder::finish() {
  if (fault) return *fault;
  if (process < 0) return failed("no frame has a picture");
  pictures.close();
  if (const int code = ended(std::exchange(process, -1)); code != 0) {
    return failed(fmt::format("ffmpeg ended with {}: {}", code, words_in(words.number())));
  }
  std::error_code failure;
  fs::rename(partial, file, failure);
  if (failure) return failed(failure.message());
  partial.clear();
  return {};
}

Result<VideoFile> VideoFile::open(const fs::path& file, double frames_per_s) {
  auto encoder = std::make_unique<Encoder>(file, frames_per_s);
  std::error_code ignored;
  const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored) || fs::is_directory(file, ignored)) {
    return encoder->failed("expected a file in a folder that is there; choose another");
  }
  encoder->words = Descriptor(::memfd_create("ffmpeg's words", MFD_CLOEXEC));
  if (encoder->words.number() < 0) return encoder->failed(std::strerror(errno));
  pid_t process = -1;
  const Descriptor nowhere(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const int fault = start({kProgram, "-version"}, -1, nowhere.number(), process);
  if (fault != 0) return without_ffmpeg(fault == ENOENT ? "none" : std::strerror(fault));
  if (const int code = ended(process); code != 0) {
    return without_ffmpeg(fmt::format("one that ends with {}", code));
  }
  if (auto made = encoder->make_partial(); !made) return made.error();
  return VideoFile(std::move(encoder));
}

void VideoFile::add(const Picture& picture) {
  if (encoder_->fault || picture.empty()) return;
  if (encoder_->process < 0) encoder_->begin(picture.size());
  if (!encoder_->fault) encoder_->send(fitted(picture, encoder_->size));
}

Result<void> VideoFile::finish() {
  auto done = encoder_->finish();
  encoder_->drop();
  return done;
}

VideoFile::VideoFile(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
VideoFile::VideoFile(VideoFile&&) noexcept = default;
VideoFile::~VideoFile() = default;

}  // namespace flowdlo::tools
