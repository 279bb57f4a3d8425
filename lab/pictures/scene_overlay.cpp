#include "pictures/scene_overlay.hpp"

#include "eval/error_overlay.hpp"
#include "files/whole_file.hpp"

namespace flowdlo::pictures {

bool save_overlay(const std::string& file, const lab::Scene& scene, const Centerline& truth,
                  const prior::Prior& prior) {
  const auto picture = eval::error_overlay_png(scene.frame(), truth, prior.nodes, prior.support);
  if (!picture) return false;
  return files::write_file(file, {*picture}).has_value();
}

}  // namespace flowdlo::pictures
