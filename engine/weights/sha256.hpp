// Sha256: FIPS 180-4. Guards the tensors of a weights file against silent damage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace flowdlo::weights {

class Sha256 {
 public:
  enum class Path { kFastest, kPortable };  ///< kFastest: the processor's SHA instructions, if any

  explicit Sha256(Path path = Path::kFastest);

  void update(std::span<const std::uint8_t> bytes);

  /// 64 lower-case hexadecimal digits of everything given to update. Ends the object's life.
  [[nodiscard]] std::string finish();

 private:
  using State = std::array<std::uint32_t, 8>;
  using Compress = void (*)(State& state, const std::uint8_t* data, std::size_t blocks);

  State state_;
  Compress compress_;
  std::array<std::uint8_t, 64> pending_{};
  std::size_t pending_bytes_ = 0;
  std::uint64_t total_bytes_ = 0;
};

}  // namespace flowdlo::weights
