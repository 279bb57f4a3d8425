#include "vulkan/pipeline_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

namespace flowdlo::vulkan {
namespace {

constexpr std::uintmax_t kLargestFile = 256U << 20U;  // bytes

struct Header {
  std::array<char, 8> magic;
  std::array<char, 32> uuid;  // of the device, hexadecimal
  std::uint32_t driver_version;
  std::uint32_t reserved;
  std::uint64_t size;      // of the data that follows
  std::uint64_t checksum;  // FNV-1a of the data
};
static_assert(sizeof(Header) == 64);

constexpr std::array<char, 8> kMagic = {'F', 'D', 'L', 'O', 'P', 'C', '0', '1'};

std::uint64_t checksum_of(const std::vector<char>& data) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : data) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  return hash;
}

Header header_for(const Device& device, const std::vector<char>& data) {
  Header header{.magic = kMagic,
                .uuid = {},
                .driver_version = device.facts().driver_version,
                .reserved = 0,
                .size = data.size(),
                .checksum = checksum_of(data)};
  const std::string& uuid = device.facts().report.uuid;
  std::memcpy(header.uuid.data(), uuid.data(), std::min(uuid.size(), header.uuid.size()));
  return header;
}

std::filesystem::path file_for(const Device& device, const std::filesystem::path& folder) {
  return folder / fmt::format("{}-{:08x}.pipelines", device.facts().report.uuid,
                              device.facts().driver_version);
}

std::vector<char> read_data(const Device& device, const std::filesystem::path& path) {
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  if (problem || size < sizeof(Header) || size > kLargestFile) return {};
  std::ifstream file(path, std::ios::binary);
  Header header{};
  if (!file.read(reinterpret_cast<char*>(&header), sizeof(header))) return {};
  std::vector<char> data(size - sizeof(header));
  if (!file.read(data.data(), static_cast<std::streamsize>(data.size()))) return {};
  const Header expected = header_for(device, data);
  if (std::memcmp(&header, &expected, sizeof(header)) != 0) return {};
  return data;
}

}  // namespace

void load_pipelines(const Device& device, const std::filesystem::path& folder) {
  const std::vector<char> data = read_data(device, file_for(device, folder));
  if (data.empty()) return;
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .pNext = nullptr,
                                       .flags = 0,
                                       .initialDataSize = data.size(),
                                       .pInitialData = data.data()};
  const auto stored =
      device.create(device.api().vkCreatePipelineCache, device.api().vkDestroyPipelineCache, info,
                    VK_OBJECT_TYPE_PIPELINE_CACHE, "stored");
  if (!stored) return;
  const VkPipelineCache source = stored->get();
  // Failing leaves the cache as it was, which is all that is needed.
  (void)device.check(
      device.api().vkMergePipelineCaches(device.handle(), device.pipeline_cache(), 1, &source),
      "vkMergePipelineCaches");
}

void store_pipelines(const Device& device, const std::filesystem::path& folder) {
  std::size_t size = 0;
  const auto get = device.api().vkGetPipelineCacheData;
  if (get(device.handle(), device.pipeline_cache(), &size, nullptr) != VK_SUCCESS) return;
  std::vector<char> data(size);
  if (get(device.handle(), device.pipeline_cache(), &size, data.data()) != VK_SUCCESS) return;
  data.resize(size);

  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  const std::filesystem::path path = file_for(device, folder);
  std::filesystem::path temporary = path;
  // Unique among all that may write at once: this process, this device.
  temporary += fmt::format(".{}.{}", getpid(), static_cast<const void*>(&device));
  {
    std::ofstream file(temporary, std::ios::binary);
    const Header header = header_for(device, data);
    file.write(reinterpret_cast<const char*>(&header), sizeof(header));
    file.write(data.data(), static_cast<std::streamsize>(data.size()));
    if (file.flush().good()) {
      std::filesystem::rename(temporary, path, problem);
      if (!problem) return;
    }
  }
  std::filesystem::remove(temporary, problem);
}

}  // namespace flowdlo::vulkan
