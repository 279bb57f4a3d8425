// Mostly a few bytes where they stand: every length and offset of a bag counts from its beginning,
// and what libFuzzer inserts or removes breaks all of them at once.
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  if (size < 16 || seed % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  constexpr std::array<std::uint8_t, 8> kTelling = {0, 1, 2, 4, 0x0C, 0x7F, 0x80, 0xFF};
  std::minstd_rand dice(seed);
  for (unsigned int i = 0; i < 1 + seed / 4 % 4; ++i) {
    std::uint8_t& byte = data[dice() % size];
    switch (dice() % 3) {
      case 0:
        byte = kTelling[dice() % kTelling.size()];
        break;
      case 1:
        byte = static_cast<std::uint8_t>(byte + dice() % 9 - 4);
        break;
      default:
        byte = static_cast<std::uint8_t>(dice());
    }
  }
  return size;
}
