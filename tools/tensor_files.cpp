#include "tensor_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "npy.hpp"

namespace flowdlo::tools {
namespace {

enum class Type { kBool, kU8 };

constexpr std::array<const char*, 10> kChannelNames = {  // docs/field.md
    "centre", "cos", "sin", "tip", "under", "under_cos", "under_sin", "width", "rope", "edge"};

/// Pixel (x, y) of the field lies at origin + scale * (x, y), pixels of the frame.
std::string region_json(const SeenStrands& strands) {
  const auto origin = [](int first, float pixels_of_field) {
    return static_cast<double>(first) + 0.5 / static_cast<double>(pixels_of_field) - 0.5;
  };
  nlohmann::ordered_json json;
  json["channels"] = kChannelNames;
  json["origin"] = {origin(strands.first_u, strands.scale_u),
                    origin(strands.first_v, strands.scale_v)};
  json["scale"] = {1 / static_cast<double>(strands.scale_u),
                   1 / static_cast<double>(strands.scale_v)};
  return json.dump(2) + "\n";
}

/// Gathers the files and the shapes that do not fit.
class Gathering {
 public:
  void add(const char* name, const std::vector<float>& values, const std::vector<int>& shape) {
    if (fits(name, values.size(), shape)) files_.emplace_back(name, npy_f32(values, shape));
  }
  void add(const char* name, const std::vector<std::uint8_t>& values, const std::vector<int>& shape,
           Type type) {
    if (!fits(name, values.size(), shape)) return;
    files_.emplace_back(name,
                        type == Type::kBool ? npy_bool(values, shape) : npy_u8(values, shape));
  }
  void add(const char* name, std::string content) { files_.emplace_back(name, std::move(content)); }
  Result<std::vector<std::pair<std::string, std::string>>> result() && {
    if (!faults_.empty()) return Error{ErrorCode::kInternal, faults_};
    return std::move(files_);
  }

 private:
  bool fits(const char* name, std::size_t count, const std::vector<int>& shape) {
    std::size_t expected = 1;
    for (const int side : shape) expected *= static_cast<std::size_t>(std::max(side, 0));
    if (count == expected) return true;
    if (!faults_.empty()) faults_ += '\n';
    faults_ += fmt::format("{}: expected {} values ({}), got {}", name, expected,
                           fmt::join(shape, " x "), count);
    return false;
  }

  std::vector<std::pair<std::string, std::string>> files_;
  std::string faults_;
};

}  // namespace

Result<std::vector<std::pair<std::string, std::string>>> tensor_files(const Tensors& tensors) {
  constexpr int kVisible = 256;
  const int draws = tensors.draws;
  const int path_points = static_cast<int>(tensors.path.size() / 2);
  Gathering files;
  files.add("source.npy", tensors.source, {draws, kNodes, 3});
  files.add("visible.npy", tensors.visible, {kVisible, 3});
  files.add("visible_valid.npy", tensors.visible_valid, {kVisible}, Type::kBool);
  files.add("path.npy", tensors.path, {path_points, 2});
  files.add("prior.npy", tensors.prior, {kNodes, 3});
  files.add("support.npy", tensors.support, {kNodes}, Type::kU8);
  files.add("draw_prior.npy", tensors.draw_prior, {draws, kNodes, 3});
  files.add("draw_support.npy", tensors.draw_support, {draws, kNodes}, Type::kU8);
  files.add("prediction.npy", tensors.prediction, {draws, kNodes, 3});
  files.add("mask_field.npy", tensors.mask_field, {4, tensors.field_height, tensors.field_width});
  const SeenStrands& strands = tensors.strands;
  if (!strands.channels.empty()) {
    files.add("field.npy", strands.channels,
              {static_cast<int>(kChannelNames.size()), strands.height, strands.width});
    files.add("field_region.json", region_json(strands));
  }
  return std::move(files).result();
}

}  // namespace flowdlo::tools
