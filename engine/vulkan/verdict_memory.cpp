#include "vulkan/verdict_memory.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>

#include "files/checksum.hpp"
#include "files/regular_file.hpp"
#include "files/staged_files.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr std::uint64_t kLargestFile = 1U << 20U;  // bytes
constexpr std::array<std::string_view, 3> kKinds = {"fine", "crashed", "hung"};

struct Own {
  std::mutex mutex;
  std::map<std::string, Verdict> verdicts;
};

/// Never destroyed: a thread that comes back to a device may outlive what the process ends with.
Own& own() {
  static Own* const memory = new Own();
  return *memory;
}

std::filesystem::path file_for(const DriverKey& key, const std::filesystem::path& folder) {
  return folder / fmt::format("driver-{:016x}.verdict", files::checksum(key.text));
}

/// What a file begins with that is about this key.
std::string head_for(const DriverKey& key) {
  return fmt::format("FlowDLO, what a Vulkan driver did: 1\n{}\n{}\n", key.text.size(), key.text);
}

std::string body_of(const Verdict& verdict) {
  return fmt::format("{} {} {}\n{}\n", kKinds[static_cast<std::size_t>(verdict.kind)],
                     verdict.devices, verdict.at, verdict.words);
}

/// The text before the next `end`, which is taken off with it.
std::string_view take(std::string_view& text, char end) {
  const auto at = text.find(end);
  const auto word = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return word;
}

template <class Number>
bool read(std::string_view word, Number& number) {
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  return problem == std::errc() && end == word.data() + word.size();
}

std::optional<Verdict> parse(std::string_view body) {
  const std::string_view whole = body;
  Verdict verdict;
  verdict.of_this_process = false;
  const std::string_view kind = take(body, ' ');
  std::size_t index = 0;
  while (index < kKinds.size() && kKinds[index] != kind) ++index;
  if (index == kKinds.size()) return std::nullopt;
  verdict.kind = static_cast<Verdict::Kind>(index);
  if (!read(take(body, ' '), verdict.devices)) return std::nullopt;
  if (!read(take(body, '\n'), verdict.at)) return std::nullopt;
  verdict.words = take(body, '\n');
  if (whole != body_of(verdict)) return std::nullopt;
  return verdict;
}

std::optional<Verdict> stored(const DriverKey& key, const std::filesystem::path& folder) {
  if (folder.empty()) return std::nullopt;
  const auto text = files::read_text(file_for(key, folder), kLargestFile);
  const std::string head = head_for(key);
  if (!text || !text->starts_with(head)) return std::nullopt;
  return parse(std::string_view(*text).substr(head.size()));
}

bool holds(const Verdict& verdict, const DriverKey& key, std::int64_t now) {
  if (verdict.kind == Verdict::Kind::kFine && key.names_library) return true;
  return verdict.at <= now && now - verdict.at < kShortMemory_s;
}

}  // namespace

std::optional<Verdict> recall(const DriverKey& key, const std::filesystem::path& folder,
                              std::int64_t now) {
  {
    const std::lock_guard lock(own().mutex);
    const auto found = own().verdicts.find(key.text);
    if (found != own().verdicts.end() && holds(found->second, key, now)) return found->second;
  }
  auto verdict = stored(key, folder);
  if (!verdict || !holds(*verdict, key, now)) return std::nullopt;
  const std::lock_guard lock(own().mutex);
  own().verdicts.insert_or_assign(key.text, *verdict);
  return verdict;
}

void remember(const DriverKey& key, const Verdict& verdict, const std::filesystem::path& folder) {
  {
    const std::lock_guard lock(own().mutex);
    own().verdicts.insert_or_assign(key.text, verdict);
  }
  if (folder.empty()) return;
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  files::StagedFiles staged(Durability::kUnsynced);
  if (staged.add(file_for(key, folder), head_for(key) + body_of(verdict))) (void)staged.commit();
}

void forget_all() {
  const std::lock_guard lock(own().mutex);
  own().verdicts.clear();
}

}  // namespace flowdlo::vulkan
