#include <nlohmann/json.hpp>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

nlohmann::ordered_json json_of(const Defects& defects) {
  return {{"gap", defects.gap},
          {"hidden_end", defects.hidden_end},
          {"outside", defects.outside},
          {"touch", defects.touch},
          {"coil", defects.coil},
          {"depth_holes", defects.depth_holes},
          {"depth_turn", defects.depth_turn},
          {"black_or_shiny", defects.black_or_shiny},
          {"depth_noise", defects.depth_noise},
          {"flying_pixels", defects.flying_pixels},
          {"edge_dropout", defects.edge_dropout},
          {"mask_ragged", defects.mask_ragged},
          {"mask_specks", defects.mask_specks},
          {"mask_gaps", defects.mask_gaps},
          {"mask_shifted", defects.mask_shifted},
          {"bars", defects.bars},
          {"hand", defects.hand},
          {"clutter", defects.clutter}};
}

}  // namespace

std::string meta_json(const Meta& meta) {
  const nlohmann::ordered_json json = {
      {"scenario", meta.scenario},
      {"ropes", meta.ropes},
      {"material", meta.material},
      {"hsv_band", {{"low", meta.band.low}, {"high", meta.band.high}}},
      {"radius_m", meta.radius_m},
      {"length_m", meta.length_m},
      {"least_bend_radius_m", meta.least_bend_radius_m},
      {"crossings", meta.crossings},
      {"intersection", meta.intersection},
      {"hanging", meta.hanging},
      {"square_ends", meta.square_ends},
      {"camera", meta.camera},
      {"distance_m", meta.distance_m},
      {"tilt_deg", meta.tilt_deg},
      {"occluders", meta.occluders},
      {"defects", json_of(meta.defects)},
      {"hard", meta.hard()},
      {"easy", meta.easy()},
      {"width_px", meta.width_px},
      {"visible_share", meta.visible_share},
      {"depth_share", meta.depth_share},
      {"longest_gap_m", meta.longest_gap_m},
      {"longest_hole_m", meta.longest_hole_m},
      {"split", meta.split},
      {"part", meta.part},
      {"seed", meta.seed},
      {"index", meta.index},
      {"frame", meta.frame},
      {"cords", meta.cords},
      {"matched", meta.matched}};
  return json.dump(2) + "\n";
}

}  // namespace flowdlo::synth
