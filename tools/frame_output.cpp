#include "frame_output.hpp"

#include <string>
#include <system_error>
#include <vector>

#include "files/folder_update.hpp"
#include "flowdlo/config.hpp"
#include "frame/centerline_csv.hpp"
#include "overlay.hpp"
#include "png_picture.hpp"
#include "tensor_files.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyFile = "estimate.json";  // while it is missing, nothing is to be read

std::vector<std::string> other_names() {
  std::vector<std::string> names = {"centerline.csv", "curve.csv", "overlay.png"};
  names.insert(names.end(), kTensorFileNames.begin(), kTensorFileNames.end());
  return names;
}

std::string centerline_name(std::size_t rope) {
  return rope == 0 ? "centerline.csv" : "centerline_" + std::to_string(rope) + ".csv";
}

// Of all but the first rope; those that stand there.
std::vector<std::string> further_centerlines(const fs::path& folder) {
  std::vector<std::string> names;
  for (std::size_t rope = 1; rope < kMostRopes; ++rope) {
    std::error_code failure;
    const std::string name = centerline_name(rope);
    const auto type = fs::symlink_status(folder / name, failure).type();
    if (type != fs::file_type::not_found) names.push_back(name);
  }
  return names;
}

Result<void> put_all(files::FolderUpdate& update, const Frame& frame, const Estimate& estimate,
                     const Extras& extras, const Provenance& provenance) {
  auto done = update.put("centerline.csv", frame::format_centerline(estimate.nodes));
  if (!done) return done;
  const auto picture =
      support::encode_png(draw_overlay(frame, estimate, provenance.device, extras.strands));
  if (!picture) return picture.error();
  if (done = update.put("overlay.png", *picture); !done) return done;
  if (!extras.curve.empty()) {
    if (done = update.put("curve.csv", frame::format_centerline(extras.curve)); !done) return done;
  }
  if (extras.tensors != nullptr) {
    const auto files = tensor_files(*extras.tensors);
    if (!files) return files.error();
    for (const auto& [name, bytes] : *files) {
      if (done = update.put(name, bytes); !done) return done;
    }
  }
  return update.put(kKeyFile, estimate_json(estimate, provenance));
}

Result<void> put_all(files::FolderUpdate& update, const Frame& frame, const TrackedRopes& tracked,
                     const Provenance& provenance) {
  for (std::size_t rope = 0; rope < tracked.found.ropes.size(); ++rope) {
    const auto text = frame::format_centerline(tracked.found.ropes[rope].nodes);
    if (auto done = update.put(centerline_name(rope), text); !done) return done;
  }
  const auto picture = support::encode_png(draw_overlay(frame, tracked, provenance.device));
  if (!picture) return picture.error();
  if (auto done = update.put("overlay.png", *picture); !done) return done;
  return update.put(kKeyFile, ropes_json(tracked, provenance));
}

}  // namespace

Result<void> forget_results(const fs::path& folder, Durability durability,
                            const files::SystemCalls& calls) {
  std::error_code failure;
  if (fs::symlink_status(folder, failure).type() == fs::file_type::not_found) return {};
  auto update = files::FolderUpdate::begin(folder, kKeyFile, durability, calls);
  if (!update) return update.error();
  update->remove(kKeyFile);
  for (const auto& name : other_names()) update->remove(name);
  for (const auto& name : further_centerlines(folder)) update->remove(name);
  return update->commit();
}

Result<void> write_estimate(const fs::path& folder, const Frame& frame, const Estimate& estimate,
                            const Extras& extras, const Provenance& provenance,
                            Durability durability, const files::SystemCalls& calls) {
  if (auto done = forget_results(folder, durability, calls); !done) return done;
  auto update = files::FolderUpdate::begin(folder, kKeyFile, durability, calls);
  if (!update) return update.error();
  auto done = put_all(*update, frame, estimate, extras, provenance);
  return done ? update->commit() : done;
}

Result<void> write_ropes(const fs::path& folder, const Frame& frame, const TrackedRopes& tracked,
                         const Provenance& provenance, Durability durability,
                         const files::SystemCalls& calls) {
  if (auto done = forget_results(folder, durability, calls); !done) return done;
  auto update = files::FolderUpdate::begin(folder, kKeyFile, durability, calls);
  if (!update) return update.error();
  auto done = put_all(*update, frame, tracked, provenance);
  return done ? update->commit() : done;
}

Result<void> write_failure(const fs::path& folder, const Error& error, const Provenance& provenance,
                           Durability durability, const files::SystemCalls& calls) {
  if (auto done = forget_results(folder, durability, calls); !done) return done;
  auto update = files::FolderUpdate::begin(folder, kKeyFile, durability, calls);
  if (!update) return update.error();
  auto done = update->put(kKeyFile, failure_json(error, provenance));
  return done ? update->commit() : done;
}

}  // namespace flowdlo::tools
