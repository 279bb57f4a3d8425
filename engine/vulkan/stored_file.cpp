#include "vulkan/stored_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "files/checksum.hpp"
#include "files/regular_file.hpp"
#include "files/staged_files.hpp"
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
          .checksum = files::checksum({content.data(), content.size()})};
}

}  // namespace

std::string stored_name(const Device& device, std::string_view kind) {
  // A CPU driver may have other lanes in the next process: what was found out of eight says nothing
  // of sixteen.
  return fmt::format("{}-{:08x}-{}.{}", device.facts().report.uuid, device.facts().driver_version,
                     device.facts().lanes, kind);
}

std::vector<char> read_stored(const Device& device, const std::filesystem::path& folder,
                              std::string_view kind) {
  const auto bytes = files::read_file(folder / stored_name(device, kind), kLargestFile);
  if (!bytes || bytes->size < sizeof(Header)) return {};
  const std::string_view text = bytes->text().substr(sizeof(Header));
  std::vector<char> content(text.begin(), text.end());
  const Header expected = header_for(device, kind, content);
  if (std::memcmp(bytes->data.get(), &expected, sizeof(Header)) != 0) return {};
  return content;
}

void write_stored(const Device& device, const std::filesystem::path& folder, std::string_view kind,
                  const std::vector<char>& content) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  const Header header = header_for(device, kind, content);
  std::string bytes;
  bytes.reserve(sizeof(header) + content.size());
  bytes.append(reinterpret_cast<const char*>(&header), sizeof(header));
  bytes.append(content.data(), content.size());
  // Its checksum tells a file that a power cut has torn: there is no need to wait for the disk.
  files::StagedFiles staged(Durability::kUnsynced);
  if (staged.add(folder / stored_name(device, kind), bytes)) (void)staged.commit();
}

}  // namespace flowdlo::vulkan
