// A .fdw file: an error, or weights without a fault.
#include "weights/fdw.hpp"

#include <cstring>
#include <memory>

#include "promise.hpp"
#include "target.hpp"

namespace weights = flowdlo::weights;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto aligned = std::make_unique<std::uint8_t[]>(size);  // as a file's bytes are
  if (size > 0) std::memcpy(aligned.get(), data, size);
  const auto file = weights::parse_fdw({aligned.get(), size}, "a.fdw");
  flowdlo::fuzz::promise(file || file.error().message.starts_with("a.fdw: "),
                         "an error names its file");
  flowdlo::fuzz::promise(!file || weights::faults(file->weights).empty(),
                         "weights that were read have no fault");
  return 0;
}
