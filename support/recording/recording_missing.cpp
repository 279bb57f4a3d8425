// Recordings of a build without rosbag_storage.
#include <fmt/format.h>

#include "recording/recording.hpp"

namespace flowdlo::recording {

struct Recording::Impl {
  std::string summary;
};

Result<std::shared_ptr<const Recording>> Recording::open(
    const std::filesystem::path& file, const RecordingOptions& /*options*/,
    const std::function<void(std::size_t, std::size_t)>& /*progress*/) {
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: this flowdlo does not read recordings: {}; install "
                           "librosbag-storage-dev and libsensor-msgs-dev, then configure and build "
                           "again",
                           file.string(), FLOWDLO_RECORDINGS_LACK)};
}

std::size_t Recording::size() const { return 0; }
std::string Recording::name(std::size_t /*index*/) const { return {}; }
const std::string& Recording::summary() const { return impl_->summary; }
Result<FrameFolder> Recording::load(std::size_t /*index*/) const {
  return Error{ErrorCode::kInternal, "recording: expected none in this build, got one"};
}
Recording::Recording(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recording::~Recording() = default;

}  // namespace flowdlo::recording
