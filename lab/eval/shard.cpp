#include "eval/shard.hpp"

#include <fmt/format.h>

#include <charconv>

namespace flowdlo::eval {
namespace {

constexpr int kMostShards = 100000;

// The whole of `text` as a number; 0 when it is none.
int number_of(std::string_view text) {
  int number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

Result<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash != std::string_view::npos) {
    const Shard shard{number_of(text.substr(0, slash)), number_of(text.substr(slash + 1))};
    if (shard.index >= 1 && shard.index <= shard.count && shard.count <= kMostShards) return shard;
  }
  return Error{ErrorCode::kBadInput,
               fmt::format("--shard: expected i/n with 1 <= i <= n <= {}, got \"{}\"; the first of "
                           "four is 1/4, the last 4/4",
                           kMostShards, text)};
}

std::filesystem::path row_file_name(const Shard& shard) {
  if (shard.whole()) return "rows.jsonl";
  return fmt::format("rows-{}-of-{}.jsonl", shard.index, shard.count);
}

}  // namespace flowdlo::eval
