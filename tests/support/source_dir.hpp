// Where this tree's own files are: examples, documents, recipes.
#pragma once

#include <filesystem>

namespace flowdlo::test {

[[nodiscard]] std::filesystem::path source_dir();

}  // namespace flowdlo::test
