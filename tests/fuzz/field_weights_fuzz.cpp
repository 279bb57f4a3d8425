// A strand field's .safetensors file: an error, or weights that a network can be made of.
#include "promise.hpp"
#include "target.hpp"
#include "weights/field_weights.hpp"

namespace weights = flowdlo::weights;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto field = weights::parse_field({data, size}, "a.safetensors");
  flowdlo::fuzz::promise(field || field.error().message.starts_with("a.safetensors: "),
                         "an error names its file");
  if (!field) return 0;
  const auto manifest = weights::field_manifest(field->sizes);
  flowdlo::fuzz::promise(field->tensors.size() == manifest.size(), "every tensor is there");
  for (std::size_t i = 0; i < manifest.size(); ++i) {
    std::size_t values = 1;
    for (const int side : manifest[i].shape) values *= static_cast<std::size_t>(side);
    flowdlo::fuzz::promise(field->tensors[i].values.size() == values, "a tensor has its shape");
  }
  return 0;
}
