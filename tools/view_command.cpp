#include "view_command.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "files/shown_name.hpp"
#include "flowdlo/estimator.hpp"
#include "frame_list.hpp"
#include "model_options.hpp"
#include "recording_arguments.hpp"
#include "rope_options.hpp"
#include "terminal.hpp"
#include "view/http_server.hpp"
#include "view/pages.hpp"
#include "view/shown_frame.hpp"

namespace flowdlo::tools {
namespace {

struct ViewOptions {
  std::vector<std::filesystem::path> frames;
  Config config;
  support::RecordingArguments recordings;
  RopeArguments ropes;
  int port = 0;
};

/// Becomes readable when the user or the system asks the program to end.
class EndSignal {
 public:
  EndSignal() {
    std::array<int, 2> ends{-1, -1};
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;
    readable_ = ends[0];
    writable = ends[1];
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, &EndSignal::came);
  }
  EndSignal(const EndSignal&) = delete;
  EndSignal& operator=(const EndSignal&) = delete;
  ~EndSignal() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    ::close(readable_);
    ::close(writable.exchange(-1));
  }

  [[nodiscard]] int readable() const { return readable_; }

 private:
  static void came(int /*signal*/) {
    const char byte = 0;
    [[maybe_unused]] const auto written = ::write(writable, &byte, 1);
  }

  static inline std::atomic<int> writable{-1};
  int readable_ = -1;
};

Result<view::Seen> seen_by(Estimator& estimator, const Frame& frame, bool several) {
  view::Seen seen;
  if (several) {
    auto ropes = estimator.estimate_ropes(frame);
    if (!ropes) return ropes.error();
    seen.ropes = *std::move(ropes);
  } else {
    auto estimate = estimator.estimate(frame, seen.tensors);
    if (!estimate) return estimate.error();
    seen.ropes.ropes.push_back(*std::move(estimate));
  }
  seen.device = estimator.device();
  return seen;
}

view::ShownFrame show(const support::FrameEntry& entry, Estimator& estimator, bool several) {
  const std::string name = files::shown(entry.name);
  const auto loaded = support::load_frame(entry);
  if (!loaded) return view::shown_failure(name, loaded.error());
  const auto seen = seen_by(estimator, loaded->frame(), several);
  auto shown = seen ? view::shown_frame(name, loaded->frame(), *seen)
                    : view::shown_frame(name, loaded->frame(), seen.error());
  return shown ? *std::move(shown) : view::shown_failure(name, shown.error());
}

support::ExitCode refused(const Error& error) {
  support::tell_error("{}\n", error.message);
  return support::ExitCode::kUsage;
}

support::ExitCode run(ViewOptions& options) {
  put_ropes(options.ropes, options.config);
  const auto frames =
      support::list_frames(options.frames, support::recording_opener(options.recordings, false));
  if (!frames) return refused(frames.error());
  if (auto there = support::all_there(*frames); !there) return refused(there.error());
  auto estimator = Estimator::create(options.config);
  if (!estimator) return refused(estimator.error());
  auto server = view::HttpServer::listen(options.port);
  if (!server) return refused(server.error());

  std::vector<std::string> names;
  for (const auto& entry : *frames) names.push_back(files::shown(entry.name));
  const std::string secret = view::secret();
  view::Pages pages(secret, std::move(names), [&](std::size_t frame) {
    return show((*frames)[frame], *estimator, options.ropes.several);
  });
  const EndSignal end;
  support::tell("http://{}/{}/\n", server->authority(), secret);
  std::fflush(stdout);
  support::tell_error("{} frame{}; open the link in a browser of this computer, Ctrl+C ends\n",
                      frames->size(), frames->size() == 1 ? "" : "s");
  const auto served = server->serve(
      [&](const view::HttpRequest& request) { return pages.response(request); }, end.readable());
  if (served) return support::ExitCode::kDone;
  support::tell_error("{}\n", served.error().message);
  return support::ExitCode::kFailed;
}

}  // namespace

void add_view_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<ViewOptions>();
  auto* command = support::add_command(
      app, "view",
      "Look at frames in a browser of this computer: image, strand field, other hypotheses, and "
      "the curve in space");
  command
      ->add_option("FRAME", options->frames,
                   "Frame folders, folders of frame folders, or ROS 1 bags")
      ->required();
  command
      ->add_option("--port", options->port,
                   "On which the page is served, to this computer alone; 0: any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535))
      ->type_name("N");
  support::add_model_options(*command, options->config);
  add_rope_options(*command, options->ropes);
  support::add_recording_options(*command, options->recordings);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
