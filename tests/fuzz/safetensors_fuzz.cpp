// A .safetensors file: an error, or weights without a fault.
#include "promise.hpp"
#include "target.hpp"
#include "weights/fdw.hpp"

namespace weights = flowdlo::weights;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = weights::parse_exchanged({data, size}, "a.safetensors");
  flowdlo::fuzz::promise(file || file.error().message.starts_with("a.safetensors: "),
                         "an error names its file");
  flowdlo::fuzz::promise(!file || weights::faults(file->weights).empty(),
                         "weights that were read have no fault");
  return 0;
}
