#include "train/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "threads/count.hpp"
#include "train/blas.hpp"

namespace flowdlo::train {
namespace {

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "CPU";
}

/// As NVIDIA's driver tells it; the runtime's own headers are not needed for that.
std::string cuda_name(int index) {
  std::vector<std::filesystem::path> cards;
  std::error_code none;
  for (const auto& card : std::filesystem::directory_iterator("/proc/driver/nvidia/gpus", none)) {
    cards.push_back(card.path());
  }
  std::sort(cards.begin(), cards.end());
  if (index < 0 || static_cast<std::size_t>(index) >= cards.size()) return "a CUDA device";
  std::ifstream stream(cards[static_cast<std::size_t>(index)] / "information");
  for (std::string line; std::getline(stream, line);) {
    const auto name = line.find_first_not_of(" \t", line.find(':') + 1);
    if (line.starts_with("Model:") && name != std::string::npos) return line.substr(name);
  }
  return "a CUDA device";
}

bool processor_multiplies_bf16() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

}  // namespace

Result<torch::Device> choose_device(const std::string& wanted) {
  const bool cuda = torch::cuda::is_available();
  if (wanted == "cuda" && !cuda) {
    return Error{ErrorCode::kNoDevice,
                 "--device cuda: expected a CUDA device and a libtorch built for it, got none; use "
                 "--device cpu, or build against another libtorch by CMAKE_PREFIX_PATH"};
  }
  if (wanted == "cpu" || !cuda) return torch::Device(torch::kCPU);
  return torch::Device(torch::kCUDA, 0);
}

std::string describe(torch::Device device) {
  if (device.is_cuda()) {
    return fmt::format("{}, libtorch {}", cuda_name(device.index()), TORCH_VERSION);
  }
  return fmt::format("{}, {} threads, libtorch {}", processor_name(), at::get_num_threads(),
                     TORCH_VERSION);
}

torch::ScalarType compute_type(Precision wanted, torch::Device device) {
  const bool bf16 = wanted == Precision::kBf16 && (device.is_cuda() || processor_multiplies_bf16());
  return bf16 ? torch::kBFloat16 : torch::kFloat32;
}

void use_threads(int threads) {
  const int count = threads::count(threads);
  at::set_num_threads(count);
  set_blas_threads(count);
}

}  // namespace flowdlo::train
