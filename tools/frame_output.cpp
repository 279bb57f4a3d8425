#include "frame_output.hpp"

#include <system_error>
#include <vector>

#include "frame/centerline_csv.hpp"
#include "frame/png.hpp"
#include "frame/staged_files.hpp"
#include "overlay.hpp"
#include "tensor_files.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

Result<void> make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!failure) return {};
  return Error{ErrorCode::kIo, folder.string() + ": cannot be made: " + failure.message()};
}

// estimate.json goes first and comes back last: while it is missing, the folder is not to be read.
Result<void> remove_earlier_run(const fs::path& folder) {
  std::vector<std::string> names = {"estimate.json", "centerline.csv", "overlay.png"};
  names.insert(names.end(), kTensorFileNames.begin(), kTensorFileNames.end());
  for (const auto& name : names) {
    std::error_code failure;
    fs::remove(folder / name, failure);
    if (failure) {
      return Error{ErrorCode::kIo,
                   (folder / name).string() + ": cannot be removed: " + failure.message()};
    }
  }
  return {};
}

Result<void> stage(frame::StagedFiles& staged, const fs::path& folder, const Frame& frame,
                   const Estimate& estimate, const Tensors* tensors, const Provenance& provenance) {
  auto done = staged.add(folder / "centerline.csv", frame::format_centerline(estimate.nodes));
  if (!done) return done;
  const auto picture = frame::encode_png(draw_overlay(frame, estimate, provenance.device));
  if (!picture) return picture.error();
  if (done = staged.add(folder / "overlay.png", *picture); !done) return done;
  if (tensors != nullptr) {
    const auto files = tensor_files(*tensors);
    if (!files) return files.error();
    for (const auto& [name, bytes] : *files) {
      if (done = staged.add(folder / name, bytes); !done) return done;
    }
  }
  return staged.add(folder / "estimate.json", estimate_json(estimate, provenance));
}

}  // namespace

Result<void> write_estimate(const fs::path& folder, const Frame& frame, const Estimate& estimate,
                            const Tensors* tensors, const Provenance& provenance) {
  if (auto done = make_folder(folder); !done) return done;
  frame::StagedFiles staged;
  if (auto done = stage(staged, folder, frame, estimate, tensors, provenance); !done) return done;
  if (auto done = remove_earlier_run(folder); !done) return done;
  return staged.commit();
}

Result<void> write_failure(const fs::path& folder, const Error& error,
                           const Provenance& provenance) {
  if (auto done = make_folder(folder); !done) return done;
  frame::StagedFiles staged;
  auto done = staged.add(folder / "estimate.json", failure_json(error, provenance));
  if (!done) return done;
  if (done = remove_earlier_run(folder); !done) return done;
  return staged.commit();
}

}  // namespace flowdlo::tools
