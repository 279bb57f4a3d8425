#include "prior_report/overlay.hpp"

#include "eval/error_overlay.hpp"
#include "frame/staged_files.hpp"

namespace flowdlo::lab {

bool save_overlay(const std::string& file, const Scene& scene, const Centerline& truth,
                  const prior::Prior& prior) {
  const auto picture = eval::error_overlay_png(scene.frame(), truth, prior.nodes, prior.support);
  if (!picture) return false;
  frame::StagedFiles files;
  return files.add(file, *picture) && files.commit();
}

}  // namespace flowdlo::lab
