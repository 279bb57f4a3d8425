// OwnFile: the file that this code was loaded from, and the folders beside which its own things
// lie.
#pragma once

#include <filesystem>
#include <vector>

namespace flowdlo::files {

/// The shared library that holds this code, or else `program`.
[[nodiscard]] std::filesystem::path own_file(const std::filesystem::path& program);

/// The program that runs; empty where the system does not tell.
[[nodiscard]] std::filesystem::path running_program();

/// The folder of `program` and three above it, for programs in bin/, lib/ and lib/<triplet>/.
[[nodiscard]] std::vector<std::filesystem::path> folders_around(
    const std::filesystem::path& program);

/// Whether somebody else may have laid it there.
[[nodiscard]] bool anybody_writes(const std::filesystem::path& path);

}  // namespace flowdlo::files
