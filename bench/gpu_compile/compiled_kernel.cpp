#include "gpu_compile/compiled_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

namespace flowdlo::gpu_compile {
namespace {

/// The extension's functions, which the engine has no use for.
struct Asking {
  explicit Asking(const vulkan::Device& device) : device_(device) {
    const auto find = [&](const char* name) {
      return device.instance().api().vkGetDeviceProcAddr(device.handle(), name);
    };
    executables = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
        find("vkGetPipelineExecutablePropertiesKHR"));
    statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        find("vkGetPipelineExecutableStatisticsKHR"));
    representations = reinterpret_cast<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
        find("vkGetPipelineExecutableInternalRepresentationsKHR"));
  }

  PFN_vkGetPipelineExecutablePropertiesKHR executables = nullptr;
  PFN_vkGetPipelineExecutableStatisticsKHR statistics = nullptr;
  PFN_vkGetPipelineExecutableInternalRepresentationsKHR representations = nullptr;

  [[nodiscard]] bool found() const {
    return executables != nullptr && statistics != nullptr && representations != nullptr;
  }

  /// Lanes of the pipeline's one executable; 0 where it has none.
  [[nodiscard]] int subgroup(VkPipeline pipeline) const {
    const VkPipelineInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pNext = nullptr, .pipeline = pipeline};
    VkPipelineExecutablePropertiesKHR properties{};
    properties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::uint32_t count = 1;
    const VkResult asked = executables(device_.handle(), &info, &count, &properties);
    return asked == VK_SUCCESS && count == 1 ? static_cast<int>(properties.subgroupSize) : 0;
  }

  [[nodiscard]] std::map<std::string, double> values(VkPipeline pipeline) const {
    const VkPipelineExecutableInfoKHR info = first_of(pipeline);
    std::uint32_t count = 0;
    statistics(device_.handle(), &info, &count, nullptr);
    VkPipelineExecutableStatisticKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> got(count, empty);
    statistics(device_.handle(), &info, &count, got.data());
    std::map<std::string, double> values;
    for (const auto& statistic : got) {
      if (statistic.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR) {
        values[statistic.name] = static_cast<double>(statistic.value.u64);
      }
    }
    return values;
  }

  [[nodiscard]] std::string assembly(VkPipeline pipeline) const {
    const VkPipelineExecutableInfoKHR info = first_of(pipeline);
    std::uint32_t count = 0;
    representations(device_.handle(), &info, &count, nullptr);
    VkPipelineExecutableInternalRepresentationKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
    std::vector<VkPipelineExecutableInternalRepresentationKHR> texts(count, empty);
    representations(device_.handle(), &info, &count, texts.data());
    std::vector<std::string> contents;
    for (auto& text : texts) contents.emplace_back(text.dataSize, '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].pData = contents[i].data();
    representations(device_.handle(), &info, &count, texts.data());
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (std::string_view(texts[i].name) == "Assembly") return contents[i];
    }
    return {};
  }

 private:
  static VkPipelineExecutableInfoKHR first_of(VkPipeline pipeline) {
    return {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
            .pNext = nullptr,
            .pipeline = pipeline,
            .executableIndex = 0};
  }

  const vulkan::Device& device_;
};

/// "BB12" at the beginning of `text`: 12.
std::optional<int> label_at(std::string_view text) {
  int label = 0;
  if (!text.starts_with("BB")) return std::nullopt;
  const auto read = std::from_chars(text.data() + 2, text.data() + text.size(), label);
  return read.ec == std::errc() ? std::optional(label) : std::nullopt;
}

struct Block {
  int label = 0;
  double instructions = 0;
  std::vector<int> branches_to;
};

std::vector<Block> blocks_of(std::string_view assembly) {
  std::vector<Block> blocks;
  while (!assembly.empty()) {
    const std::size_t end = std::min(assembly.find('\n'), assembly.size());
    std::string_view line = assembly.substr(0, end);
    assembly.remove_prefix(std::min(end + 1, assembly.size()));
    if (const auto label = label_at(line)) {
      blocks.push_back({*label, 0, {}});
      continue;
    }
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (blocks.empty() || line.empty() || line.front() == '\0') continue;
    blocks.back().instructions += 1;
    if (line.find("branch") == std::string_view::npos) continue;
    const std::size_t space = line.find(' ');
    if (space == std::string_view::npos) continue;
    if (const auto target = label_at(line.substr(space + 1))) {
      blocks.back().branches_to.push_back(*target);
    }
  }
  return blocks;
}

}  // namespace

std::vector<double> instructions_by_depth(std::string_view assembly) {
  const std::vector<Block> blocks = blocks_of(assembly);
  // A branch back makes a loop of all blocks between; several to one place are one loop.
  std::map<int, int> loops;  // first label, last label
  for (const Block& block : blocks) {
    for (const int target : block.branches_to) {
      if (target <= block.label) loops[target] = std::max(loops[target], block.label);
    }
  }
  std::vector<double> counts(1);
  for (const Block& block : blocks) {
    std::size_t depth = 0;
    for (const auto& [first, last] : loops) depth += block.label >= first && block.label <= last;
    if (counts.size() <= depth) counts.resize(depth + 1);
    counts[depth] += block.instructions;
  }
  return counts;
}

Result<CompiledKernel> figures_of(const vulkan::Device& device, const vulkan::KernelSpec& spec,
                                  const vulkan::Kernel& kernel) {
  const Asking asking(device);
  if (!asking.found()) {
    return Error{ErrorCode::kInternal,
                 fmt::format("\"{}\": expected {}, found none", device.facts().report.name,
                             "VK_KHR_pipeline_executable_properties")};
  }
  const std::map<std::string, double> values = asking.values(kernel.pipeline());
  std::string missing;
  const auto value = [&](const std::string& name) {
    const auto known = values.find(name);
    if (known == values.end()) missing += (missing.empty() ? "" : ", ") + name;
    return known == values.end() ? 0.0 : known->second;
  };
  const auto count = [&](const std::string& name) { return static_cast<int>(value(name)); };
  CompiledKernel compiled{
      .name = spec.name(),
      .subgroup = asking.subgroup(kernel.pipeline()),
      .vgprs = count("VGPRs"),
      .sgprs = count("SGPRs"),
      .spilled = count("Spilled VGPRs") + count("Spilled SGPRs"),
      .scratch_bytes = count("Scratch size"),
      .lds_bytes = count("LDS size"),
      .code_bytes = count("Code size"),
      .waves = count("Subgroups per SIMD"),
      .latency = value("Latency"),
      .cycles_of_64 = value("Inverse Throughput"),
      .instructions_by_depth = instructions_by_depth(asking.assembly(kernel.pipeline()))};
  if (!missing.empty()) {
    return Error{ErrorCode::kInternal,
                 fmt::format("\"{}\" says of {} no {}; install Mesa 22.3 or newer",
                             device.facts().report.name, spec.name(), missing)};
  }
  return compiled;
}

}  // namespace flowdlo::gpu_compile
