#include "vulkan/stored_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "flowdlo/version.hpp"
#include "vulkan/shader_code.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr std::uintmax_t kLargestFile = 256U << 20U;  // bytes

struct Header {
  std::array<char, 8> magic;
  std::array<char, 16> kind;
  std::array<char, 32> device;  // UUIDs, hexadecimal
  std::array<char, 32> driver;
  std::array<std::uint32_t, 4> versions;  // of the driver, of FlowDLO
  std::uint64_t shaders;
  std::uint64_t size;      // of the content that follows
  std::uint64_t checksum;  // FNV-1a of the content
};
static_assert(sizeof(Header) == 128);

constexpr std::array<char, 8> kMagic = {'F', 'D', 'L', 'O', 'S', 'F', '0', '2'};

std::uint64_t checksum_of(const std::vector<char>& content) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : content) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  return hash;
}

template <std::size_t kSize>
std::array<char, kSize> padded(std::string_view text) {
  std::array<char, kSize> result{};
  std::copy_n(text.begin(), std::min(text.size(), kSize), result.begin());
  return result;
}

Header header_for(const Device& device, std::string_view kind, const std::vector<char>& content) {
  return {.magic = kMagic,
          .kind = padded<16>(kind),
          .device = padded<32>(device.facts().report.uuid),
          .driver = padded<32>(device.facts().driver_uuid),
          .versions = {device.facts().driver_version, FLOWDLO_VERSION_MAJOR, FLOWDLO_VERSION_MINOR,
                       FLOWDLO_VERSION_PATCH},
          .shaders = shaders::hash(),
          .size = content.size(),
          .checksum = checksum_of(content)};
}

std::filesystem::path file_for(const Device& device, const std::filesystem::path& folder,
                               std::string_view kind) {
  // A CPU driver may have other lanes in the next process: what was found out of eight says nothing
  // of sixteen.
  return folder / fmt::format("{}-{:08x}-{}.{}", device.facts().report.uuid,
                              device.facts().driver_version, device.facts().lanes, kind);
}

}  // namespace

std::vector<char> read_stored(const Device& device, const std::filesystem::path& folder,
                              std::string_view kind) {
  const std::filesystem::path path = file_for(device, folder, kind);
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  if (problem || size < sizeof(Header) || size > kLargestFile) return {};
  std::ifstream file(path, std::ios::binary);
  Header header{};
  if (!file.read(reinterpret_cast<char*>(&header), sizeof(header))) return {};
  std::vector<char> content(size - sizeof(header));
  if (!file.read(content.data(), static_cast<std::streamsize>(content.size()))) return {};
  const Header expected = header_for(device, kind, content);
  if (std::memcmp(&header, &expected, sizeof(header)) != 0) return {};
  return content;
}

void write_stored(const Device& device, const std::filesystem::path& folder, std::string_view kind,
                  const std::vector<char>& content) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  const std::filesystem::path path = file_for(device, folder, kind);
  std::filesystem::path temporary = path;
  // Unique among all that may write at once: this process, this device.
  temporary += fmt::format(".{}.{}", getpid(), static_cast<const void*>(&device));
  {
    std::ofstream file(temporary, std::ios::binary);
    const Header header = header_for(device, kind, content);
    file.write(reinterpret_cast<const char*>(&header), sizeof(header));
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (file.flush().good()) {
      std::filesystem::rename(temporary, path, problem);
      if (!problem) return;
    }
  }
  std::filesystem::remove(temporary, problem);
}

}  // namespace flowdlo::vulkan
