#include "train/golden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "evidence/visible_points.hpp"
#include "files/whole_file.hpp"
#include "geometry/camera.hpp"
#include "train/record_file.hpp"

namespace flowdlo::train {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;
constexpr float kHalfWidth_px = 2.2F;
constexpr float kDepth_m = 0.41F;

/// The rope's middle at `share` of its length: an arc from left to right.
Eigen::Vector2f middle_px(float share) {
  const float bow = 1 - 4 * (share - 0.5F) * (share - 0.5F);
  return {10 + 74 * share, 24 + 26 * bow};
}

bool on_rope(int u, int v) {
  constexpr int kSteps = 300;
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector2f at = middle_px(static_cast<float>(i) / kSteps);
    const float du = static_cast<float>(u) - at.x();
    const float dv = static_cast<float>(v) - at.y();
    if (du * du + dv * dv <= kHalfWidth_px * kHalfWidth_px) return true;
  }
  return false;
}

nlohmann::json to_json(const GoldenCase& one) {
  const auto& variant = one.variant;
  return {{"parameterization", static_cast<int>(variant.parameterization)},
          {"local_channels", variant.local_channels},
          {"visible_points", variant.visible_points},
          {"head_channels", variant.head_channels},
          {"frame_normalization", variant.normalization == weights::NormalizationKind::kFrame},
          {"velocity", one.velocity},
          {"nodes", one.nodes}};
}

GoldenCase from_json(const nlohmann::json& json) {
  GoldenCase one;
  auto& variant = one.variant;
  variant.parameterization =
      static_cast<ops::Parameterization>(json.at("parameterization").get<int>());
  variant.local_channels = json.at("local_channels").get<int>();
  variant.visible_points = json.at("visible_points").get<bool>();
  variant.head_channels = json.at("head_channels").get<int>();
  variant.normalization = json.at("frame_normalization").get<bool>()
                              ? weights::NormalizationKind::kFrame
                              : weights::NormalizationKind::kGlobal;
  one.velocity = json.at("velocity").get<std::vector<float>>();
  one.nodes = json.at("nodes").get<std::vector<float>>();
  return one;
}

}  // namespace

Record golden_record() {
  constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth) * kHeight;
  std::vector<std::uint8_t> mask(kPixels, 0);
  std::vector<float> depth(kPixels, 0.48F);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      if (!on_rope(u, v)) continue;
      const auto pixel = static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
      mask[pixel] = 255;
      const bool hole = u > 50 && u < 58;
      depth[pixel] = hole ? 0.0F : kDepth_m + 0.0005F * static_cast<float>(u);
    }
  }
  const Frame frame{kWidth, kHeight, {.fx = 90, .fy = 91, .cx = 47.2F, .cy = 36.1F},
                    depth,  mask,    {}};
  Record record;
  record.scenario = "golden";
  record.camera = frame.intrinsics;
  record.mask = runs_of(frame);
  record.visible = evidence::visible_points(evidence::unproject(frame));
  PriorState prior;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const float share = static_cast<float>(node) / (kNodes - 1);
    const Eigen::Vector2f at = middle_px(share);
    const float depth_m = kDepth_m + 0.0005F * at.x();
    record.truth[node] = geometry::unproject(frame.intrinsics, at.x(), at.y(), depth_m);
    prior.nodes[node] = geometry::unproject(frame.intrinsics, at.x() + 1, at.y() - 1.5F, depth_m);
    prior.support[node] = node % 7 == 3 ? 0 : 1;
  }
  record.priors.push_back(prior);
  record.depth_m = depth;
  return record;
}

std::vector<weights::Variant> golden_variants() {
  using ops::Parameterization;
  using weights::NormalizationKind;
  weights::Variant thesis;
  weights::Variant robust;
  robust.parameterization = Parameterization::kPreconditioned;
  robust.normalization = NormalizationKind::kFrame;
  robust.head_channels = 4;
  weights::Variant direct;
  direct.parameterization = Parameterization::kDirect;
  weights::Variant depth;
  depth.local_channels = 8;
  weights::Variant blind;
  blind.visible_points = false;
  return {thesis, robust, direct, depth, blind};
}

Result<void> write_golden(const std::vector<GoldenCase>& cases,
                          const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  Shard shard;
  shard.origin = "golden";
  shard.scenes = 1;
  shard.records.push_back(golden_record());
  if (auto written = write_shard(shard, folder / "golden.records"); !written) return written;
  nlohmann::json json = nlohmann::json::array();
  for (const GoldenCase& one : cases) json.push_back(to_json(one));
  const std::string text = json.dump() + "\n";
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return files::write_file(folder / "golden.json", {{bytes, text.size()}});
}

Result<std::vector<GoldenCase>> read_golden(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "golden.json");
  const auto json = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (!json.is_array()) {
    return Error{ErrorCode::kIo,
                 fmt::format("{}: expected golden.json of flowdlo-train golden", folder.string())};
  }
  try {
    std::vector<GoldenCase> cases;
    for (const auto& one : json) cases.push_back(from_json(one));
    return cases;
  } catch (const nlohmann::json::exception& thrown) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: {}", (folder / "golden.json").string(), thrown.what())};
  }
}

}  // namespace flowdlo::train
