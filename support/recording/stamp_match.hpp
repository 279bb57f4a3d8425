// StampMatch: which messages of several topics belong to one moment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flowdlo::recording {

/// For each stamp of `leader` the index of its partner in `other`, if it has one: the nearest, at
/// most `tolerance_ns` away, whose own nearest it is. So no message has two partners, and neither
/// the order of the messages nor what was lost between them matters. Of two equally near the
/// earlier counts.
[[nodiscard]] std::vector<std::optional<std::size_t>> match_stamps(
    std::span<const std::int64_t> leader, std::span<const std::int64_t> other,
    std::int64_t tolerance_ns);

/// Index of the last of `stamps` that is not after `moment`; the first where all are after it.
/// `stamps` is not empty.
[[nodiscard]] std::size_t latest_until(std::span<const std::int64_t> stamps, std::int64_t moment);

}  // namespace flowdlo::recording
