#include "support/source_dir.hpp"

namespace flowdlo::test {

std::filesystem::path source_dir() { return FLOWDLO_SOURCE_DIR; }

}  // namespace flowdlo::test
