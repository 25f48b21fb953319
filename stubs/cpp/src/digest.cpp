#include "fc_runtime/digest.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace fc_runtime {

namespace {

constexpr std::array<std::uint32_t, 64> kSines = {
    0xd76aa478U, 0xe8c7b756U, 0x242070dbU, 0xc1bdceeeU, 0xf57c0fafU, 0x4787c62aU, 0xa8304613U,
    0xfd469501U, 0x698098d8U, 0x8b44f7afU, 0xffff5bb1U, 0x895cd7beU, 0x6b901122U, 0xfd987193U,
    0xa679438eU, 0x49b40821U, 0xf61e2562U, 0xc040b340U, 0x265e5a51U, 0xe9b6c7aaU, 0xd62f105dU,
    0x02441453U, 0xd8a1e681U, 0xe7d3fbc8U, 0x21e1cde6U, 0xc33707d6U, 0xf4d50d87U, 0x455a14edU,
    0xa9e3e905U, 0xfcefa3f8U, 0x676f02d9U, 0x8d2a4c8aU, 0xfffa3942U, 0x8771f681U, 0x6d9d6122U,
    0xfde5380cU, 0xa4beea44U, 0x4bdecfa9U, 0xf6bb4b60U, 0xbebfbc70U, 0x289b7ec6U, 0xeaa127faU,
    0xd4ef3085U, 0x04881d05U, 0xd9d4d039U, 0xe6db99e5U, 0x1fa27cf8U, 0xc4ac5665U, 0xf4292244U,
    0x432aff97U, 0xab9423a7U, 0xfc93a039U, 0x655b59c3U, 0x8f0ccc92U, 0xffeff47dU, 0x85845dd1U,
    0x6fa87e4fU, 0xfe2ce6e0U, 0xa3014314U, 0x4e0811a1U, 0xf7537e82U, 0xbd3af235U, 0x2ad7d2bbU,
    0xeb86d391U};
constexpr std::array<unsigned, 16> kTurns = {7, 12, 17, 22, 5, 9,  14, 20,
                                             4, 11, 16, 23, 6, 10, 15, 21};

constexpr std::uint32_t turned(std::uint32_t word, unsigned bits) {
  return word << bits | word >> (32U - bits);
}

/// One of the 64 steps. The compiler unrolls the loop around it.
template <unsigned Round>
inline void step(std::uint32_t& a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                 std::uint32_t word, std::uint32_t sine, unsigned turn) {
  std::uint32_t mixed = 0;
  if constexpr (Round == 0) mixed = d ^ (b & (c ^ d));
  if constexpr (Round == 1) mixed = c ^ (d & (b ^ c));
  if constexpr (Round == 2) mixed = b ^ c ^ d;
  if constexpr (Round == 3) mixed = c ^ (b | ~d);
  a = b + turned(a + mixed + word + sine, turn);
}

/// Runs the steps of a round. The first step takes word `First`; each next one advances by
/// `Stride`.
template <unsigned Round, unsigned First, unsigned Stride>
inline void round(std::array<std::uint32_t, 4>& state, const std::array<std::uint32_t, 16>& words) {
  auto [a, b, c, d] = state;
  for (std::size_t at = 0; at < 16; at += 4) {
    const auto word = [&](std::size_t offset) {
      return words[(First + (at + offset) * Stride) % 16];
    };
    const std::size_t sine = Round * 16 + at;
    step<Round>(a, b, c, d, word(0), kSines[sine], kTurns[Round * 4]);
    step<Round>(d, a, b, c, word(1), kSines[sine + 1], kTurns[Round * 4 + 1]);
    step<Round>(c, d, a, b, word(2), kSines[sine + 2], kTurns[Round * 4 + 2]);
    step<Round>(b, c, d, a, word(3), kSines[sine + 3], kTurns[Round * 4 + 3]);
  }
  state = {a, b, c, d};
}

}  // namespace

void Md5::block(const std::uint8_t* bytes) {
  std::array<std::uint32_t, 16> words{};
  for (std::size_t at = 0; at < words.size(); ++at) {
    const std::uint8_t* word = bytes + at * 4;
    words[at] = std::uint32_t{word[0]} | std::uint32_t{word[1]} << 8U |
                std::uint32_t{word[2]} << 16U | std::uint32_t{word[3]} << 24U;
  }
  const auto before = state_;
  round<0, 0, 1>(state_, words);
  round<1, 1, 5>(state_, words);
  round<2, 5, 3>(state_, words);
  round<3, 0, 7>(state_, words);
  for (std::size_t at = 0; at < state_.size(); ++at) state_[at] += before[at];
}

void Md5::update(std::string_view data) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(data.data());
  std::size_t left = data.size();
  const std::size_t held = static_cast<std::size_t>(length_ % 64);
  length_ += left;
  if (held > 0) {
    const std::size_t taken = std::min(left, 64 - held);
    std::copy_n(bytes, taken, rest_.begin() + static_cast<std::ptrdiff_t>(held));
    bytes += taken;
    left -= taken;
    if (held + taken < 64) return;
    block(rest_.data());
  }
  for (; left >= 64; left -= 64, bytes += 64) block(bytes);
  if (left > 0) std::copy_n(bytes, left, rest_.begin());
}

Sum Md5::finish() {
  const std::uint64_t bits = length_ * 8;
  std::string_view padding(
      "\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
      64);
  const auto held = static_cast<std::size_t>(length_ % 64);
  update(padding.substr(0, held < 56 ? 56 - held : 120 - held));
  std::array<char, 8> length{};
  for (std::size_t at = 0; at < length.size(); ++at) {
    length[at] = static_cast<char>(bits >> (8 * at) & 0xFFU);
  }
  update({length.data(), length.size()});
  Sum digest{};
  for (std::size_t at = 0; at < digest.size(); ++at) {
    digest[at] = static_cast<std::uint8_t>(state_[at / 4] >> (8 * (at % 4)));
  }
  return digest;
}

Sum digest_of(DigestAlgorithm algorithm, std::string_view data) {
  Sum digest{};
  if (algorithm == DigestAlgorithm::Md5) {
    Md5 md5;
    md5.update(data);
    digest = md5.finish();
  } else if (algorithm == DigestAlgorithm::Crc32) {
    const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(data.data()), data.size());
    for (std::size_t at = 0; at < 4; ++at) {
      digest[at] = static_cast<std::uint8_t>(sum >> (8 * (3 - at)));
    }
  }
  return digest;
}

}  // namespace fc_runtime
