// What libFuzzer does to an input, and then the length in front of the header made to fit: without
// that no mutation of the header's length leaves it JSON.
#include <cstddef>
#include <cstdint>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::size_t kLengthBytes = 8;

/// Behind the brace that closes the first one; `size` where none does.
std::size_t end_of_header(const std::uint8_t* data, std::size_t size) {
  int open = 0;
  for (std::size_t at = kLengthBytes; at < size; ++at) {
    if (data[at] == '{') ++open;
    if (data[at] == '}' && --open == 0) return at + 1;
  }
  return size;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 8 == 0 || mutated < kLengthBytes) return mutated;
  const std::uint64_t length = end_of_header(data, mutated) - kLengthBytes;
  std::memcpy(data, &length, kLengthBytes);
  return mutated;
}
