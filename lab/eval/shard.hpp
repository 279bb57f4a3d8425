// Shard: the part of a data set that one of several processes evaluates.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Part `index` of `count`, from 1: every count-th row, so that each part holds every kind of
/// scene.
struct Shard {
  int index = 1;
  int count = 1;

  [[nodiscard]] bool whole() const { return count == 1; }
  [[nodiscard]] bool owns(std::size_t row) const {
    return row % static_cast<std::size_t>(count) == static_cast<std::size_t>(index - 1);
  }

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// Of "2/8". Fails with kBadInput unless 1 <= index <= count <= 100000.
[[nodiscard]] Result<Shard> parse_shard(std::string_view text);

/// rows.jsonl of the whole, rows-2-of-8.jsonl of a part: parts may share a folder.
[[nodiscard]] std::filesystem::path row_file_name(const Shard& shard);

}  // namespace flowdlo::eval
