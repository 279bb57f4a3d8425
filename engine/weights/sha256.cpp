#include "weights/sha256.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#include <immintrin.h>
#define FLOWDLO_SHA_INSTRUCTIONS 1
#endif

namespace flowdlo::weights {
namespace {

using State = std::array<std::uint32_t, 8>;
constexpr std::size_t kBlockBytes = 64;

// FIPS 180-4, Sec. 5.3.3 and 4.2.2.
constexpr State kInitial = {0x6a09e667U, 0xbb67ae85U, 0x3c6ef372U, 0xa54ff53aU,
                            0x510e527fU, 0x9b05688cU, 0x1f83d9abU, 0x5be0cd19U};
alignas(16) constexpr std::array<std::uint32_t, 64> kRound = {
    0x428a2f98U, 0x71374491U, 0xb5c0fbcfU, 0xe9b5dba5U, 0x3956c25bU, 0x59f111f1U, 0x923f82a4U,
    0xab1c5ed5U, 0xd807aa98U, 0x12835b01U, 0x243185beU, 0x550c7dc3U, 0x72be5d74U, 0x80deb1feU,
    0x9bdc06a7U, 0xc19bf174U, 0xe49b69c1U, 0xefbe4786U, 0x0fc19dc6U, 0x240ca1ccU, 0x2de92c6fU,
    0x4a7484aaU, 0x5cb0a9dcU, 0x76f988daU, 0x983e5152U, 0xa831c66dU, 0xb00327c8U, 0xbf597fc7U,
    0xc6e00bf3U, 0xd5a79147U, 0x06ca6351U, 0x14292967U, 0x27b70a85U, 0x2e1b2138U, 0x4d2c6dfcU,
    0x53380d13U, 0x650a7354U, 0x766a0abbU, 0x81c2c92eU, 0x92722c85U, 0xa2bfe8a1U, 0xa81a664bU,
    0xc24b8b70U, 0xc76c51a3U, 0xd192e819U, 0xd6990624U, 0xf40e3585U, 0x106aa070U, 0x19a4c116U,
    0x1e376c08U, 0x2748774cU, 0x34b0bcb5U, 0x391c0cb3U, 0x4ed8aa4aU, 0x5b9cca4fU, 0x682e6ff3U,
    0x748f82eeU, 0x78a5636fU, 0x84c87814U, 0x8cc70208U, 0x90befffaU, 0xa4506cebU, 0xbef9a3f7U,
    0xc67178f2U};

std::uint32_t big_endian(const std::uint8_t* data) {
  return std::uint32_t{data[0]} << 24U | std::uint32_t{data[1]} << 16U |
         std::uint32_t{data[2]} << 8U | std::uint32_t{data[3]};
}

using Word = std::uint32_t;

/// FIPS 180-4, Sec. 6.2.2, step 3, in place: the next e is left in d, the next a in h.
inline void round(Word a, Word b, Word c, Word& d, Word e, Word f, Word g, Word& h, Word keyed) {
  const Word sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
  const Word first = h + sum1 + ((e & f) ^ (~e & g)) + keyed;
  const Word sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
  d += first;
  h = first + sum0 + ((a & b) ^ (a & c) ^ (b & c));
}

void compress_block(State& state, const std::uint8_t* data) {
  std::array<std::uint32_t, 64> words;
  for (std::size_t i = 0; i < 16; ++i) words[i] = big_endian(data + 4 * i);
  for (std::size_t i = 16; i < 64; ++i) {
    const std::uint32_t early = words[i - 15];
    const std::uint32_t late = words[i - 2];
    const std::uint32_t sigma0 = std::rotr(early, 7) ^ std::rotr(early, 18) ^ (early >> 3U);
    const std::uint32_t sigma1 = std::rotr(late, 17) ^ std::rotr(late, 19) ^ (late >> 10U);
    words[i] = words[i - 16] + sigma0 + words[i - 7] + sigma1;
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t i = 0; i < 64; i += 8) {
    // Instead of moving the eight variables along, each round takes them one place further.
    round(a, b, c, d, e, f, g, h, kRound[i] + words[i]);
    round(h, a, b, c, d, e, f, g, kRound[i + 1] + words[i + 1]);
    round(g, h, a, b, c, d, e, f, kRound[i + 2] + words[i + 2]);
    round(f, g, h, a, b, c, d, e, kRound[i + 3] + words[i + 3]);
    round(e, f, g, h, a, b, c, d, kRound[i + 4] + words[i + 4]);
    round(d, e, f, g, h, a, b, c, kRound[i + 5] + words[i + 5]);
    round(c, d, e, f, g, h, a, b, kRound[i + 6] + words[i + 6]);
    round(b, c, d, e, f, g, h, a, kRound[i + 7] + words[i + 7]);
  }
  const State change = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += change[i];
}

void compress_portable(State& state, const std::uint8_t* data, std::size_t blocks) {
  for (std::size_t i = 0; i < blocks; ++i) compress_block(state, data + kBlockBytes * i);
}

#ifdef FLOWDLO_SHA_INSTRUCTIONS
bool has_sha_instructions() {
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_SSE4_1) == 0) return false;
  constexpr unsigned kSha = 1U << 29U;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & kSha) != 0;
}

// The instructions keep the state as two vectors, (a, b, e, f) and (c, d, g, h), first in the top
// lane; one makes two rounds, and its result takes the place of the older pair.
__attribute__((target("sha,sse4.1"))) void compress_x86(State& state, const std::uint8_t* data,
                                                        std::size_t blocks) {
  const auto lane = [&state](std::size_t i) { return std::bit_cast<int>(state[i]); };
  const __m128i bytes_reversed = _mm_set_epi64x(0x0c0d0e0f08090a0bLL, 0x0405060700010203LL);
  __m128i abef = _mm_set_epi32(lane(0), lane(1), lane(4), lane(5));
  __m128i cdgh = _mm_set_epi32(lane(2), lane(3), lane(6), lane(7));
  for (std::size_t block = 0; block < blocks; ++block, data += kBlockBytes) {
    const __m128i abef_before = abef;
    const __m128i cdgh_before = cdgh;
    __m128i words[16];
    for (int i = 0; i < 16; ++i) {
      if (i < 4) {
        const auto* source = reinterpret_cast<const __m128i*>(data + 16 * i);
        words[i] = _mm_shuffle_epi8(_mm_loadu_si128(source), bytes_reversed);
      } else {
        const __m128i seven_back = _mm_alignr_epi8(words[i - 1], words[i - 2], 4);
        const __m128i sum =
            _mm_add_epi32(_mm_sha256msg1_epu32(words[i - 4], words[i - 3]), seven_back);
        words[i] = _mm_sha256msg2_epu32(sum, words[i - 1]);
      }
      const auto* round = reinterpret_cast<const __m128i*>(kRound.data() + 4 * i);
      const __m128i keyed = _mm_add_epi32(words[i], _mm_load_si128(round));
      cdgh = _mm_sha256rnds2_epu32(cdgh, abef, keyed);
      abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(keyed, 0x0E));
    }
    abef = _mm_add_epi32(abef, abef_before);
    cdgh = _mm_add_epi32(cdgh, cdgh_before);
  }
  const auto word = [](int value) { return std::bit_cast<std::uint32_t>(value); };
  state = {word(_mm_extract_epi32(abef, 3)), word(_mm_extract_epi32(abef, 2)),
           word(_mm_extract_epi32(cdgh, 3)), word(_mm_extract_epi32(cdgh, 2)),
           word(_mm_extract_epi32(abef, 1)), word(_mm_extract_epi32(abef, 0)),
           word(_mm_extract_epi32(cdgh, 1)), word(_mm_extract_epi32(cdgh, 0))};
}
#endif

}  // namespace

Sha256::Sha256(Path path) : state_(kInitial), compress_(compress_portable) {
#ifdef FLOWDLO_SHA_INSTRUCTIONS
  if (path == Path::kFastest && has_sha_instructions()) compress_ = compress_x86;
#else
  static_cast<void>(path);
#endif
}

void Sha256::update(std::span<const std::uint8_t> bytes) {
  total_bytes_ += bytes.size();
  if (pending_bytes_ > 0) {
    const std::size_t taken = std::min(bytes.size(), kBlockBytes - pending_bytes_);
    std::copy_n(bytes.begin(), taken, pending_.begin() + static_cast<long>(pending_bytes_));
    pending_bytes_ += taken;
    bytes = bytes.subspan(taken);
    if (pending_bytes_ < kBlockBytes) return;
    compress_(state_, pending_.data(), 1);
    pending_bytes_ = 0;
  }
  const std::size_t blocks = bytes.size() / kBlockBytes;
  compress_(state_, bytes.data(), blocks);
  bytes = bytes.subspan(blocks * kBlockBytes);
  std::copy(bytes.begin(), bytes.end(), pending_.begin());
  pending_bytes_ = bytes.size();
}

std::string Sha256::finish() {
  const std::uint64_t bits = 8 * total_bytes_;
  pending_[pending_bytes_++] = 0x80;
  const auto rest = [this] { return pending_.begin() + static_cast<long>(pending_bytes_); };
  if (pending_bytes_ > kBlockBytes - 8) {
    std::fill(rest(), pending_.end(), std::uint8_t{0});
    compress_(state_, pending_.data(), 1);
    pending_bytes_ = 0;
  }
  std::fill(rest(), pending_.end(), std::uint8_t{0});
  for (std::size_t i = 0; i < 8; ++i) {
    pending_[kBlockBytes - 1 - i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
  compress_(state_, pending_.data(), 1);
  std::string text;
  for (const std::uint32_t word : state_) text += fmt::format("{:08x}", word);
  return text;
}

}  // namespace flowdlo::weights
