// The splits' names and sizes.
#include <algorithm>
#include <array>

#include "scene/scene.hpp"
#include "synth/group.hpp"
#include "synth/rope.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

// Scenes of each group in kThesisScenarios' order. The thesis tells the validation counts and both
// sums (Sec. 4.1.1); of the training counts it tells the sum, and they follow the validation's.
constexpr std::array<std::uint64_t, 9> kTraining = {24, 24, 10, 32, 28, 32, 8, 30, 46};
constexpr std::array<std::uint64_t, 9> kValidation = {6, 6, 2, 8, 7, 8, 2, 8, 12};

const std::array<std::uint64_t, 9>& counts_of(Part part) {
  return part == Part::kTraining ? kTraining : kValidation;
}

}  // namespace

std::string_view name_of(Split split) {
  switch (split) {
    case Split::kThesis:
      return "thesis";
    case Split::kWide:
      return "wide";
    case Split::kSeveral:
      return "several";
    case Split::kTangled:
      return "tangled";
    case Split::kDrawn:
      break;
  }
  return "drawn";
}

std::string_view name_of(Part part) { return part == Part::kTraining ? "training" : "validation"; }

std::optional<Split> split_of(std::string_view name) {
  for (const Split split :
       {Split::kThesis, Split::kWide, Split::kSeveral, Split::kDrawn, Split::kTangled}) {
    if (name == name_of(split)) return split;
  }
  return std::nullopt;
}

std::optional<Part> part_of(std::string_view name) {
  if (name == "training") return Part::kTraining;
  if (name == "validation") return Part::kValidation;
  return std::nullopt;
}

std::uint64_t scene_count(Split split, Part part) {
  if (split != Split::kThesis) return 0;
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counts_of(part)) sum += count;
  return sum;
}

std::span<const std::string_view> scenarios(Split split) {
  if (split == Split::kThesis) return kThesisScenarios;
  if (split == Split::kSeveral) return kSeveralScenarios;
  if (split == Split::kTangled) return kTangledScenarios;
  if (split == Split::kDrawn) return lab::kind_names();
  return kWideScenarios;
}

std::string_view thesis_group(Part part, std::uint64_t index) {
  const auto& counts = counts_of(part);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (index < counts[k]) return kThesisScenarios[k];
    index -= counts[k];
  }
  return kThesisScenarios.back();
}

}  // namespace flowdlo::synth
