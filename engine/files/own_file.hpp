// OwnFile: the file that this code was loaded from, and the folders beside which its own things
// lie.
#pragma once

#include <filesystem>
#include <vector>

namespace flowdlo::files {

/// The shared library that holds this code, or else `program`.
[[nodiscard]] std::filesystem::path own_file(const std::filesystem::path& program);

/// The program that runs, also in a chroot without /proc; empty where the system does not tell.
[[nodiscard]] std::filesystem::path running_program();

/// The same by the name that the system was given when it began; empty where that names no file any
/// more, since it may be relative to a past directory.
[[nodiscard]] std::filesystem::path program_that_began_as(const char* name);

/// The folder of `program` and three above it, for programs in bin/, lib/ and lib/<triplet>/.
[[nodiscard]] std::vector<std::filesystem::path> folders_around(
    const std::filesystem::path& program);

/// Whether somebody else may have laid it there.
[[nodiscard]] bool anybody_writes(const std::filesystem::path& path);

}  // namespace flowdlo::files
