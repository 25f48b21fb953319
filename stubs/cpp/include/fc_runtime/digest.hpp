// Digests that protect the data of a frame against transmission errors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fc_runtime {

/// The digest algorithm. It detects damage in transit, not manipulation.
enum class DigestAlgorithm {
  None,   ///< No digest. TCP and the parser detect damage.
  Crc32,  ///< CRC-32 as in gzip; most significant byte first.
  Md5,    ///< MD5 (RFC 1321).
};

/// Space for the longest digest. A shorter one occupies the first bytes, followed by zeros.
using Sum = std::array<std::uint8_t, 16>;

/// MD5 (RFC 1321) of data in several pieces.
class Md5 {
 public:
  /// Adds data.
  void update(std::string_view data);
  /// Returns the digest of all added data. Do not use the object afterwards.
  [[nodiscard]] Sum finish();

 private:
  void block(const std::uint8_t* bytes);

  std::array<std::uint32_t, 4> state_ = {0x67452301U, 0xEFCDAB89U, 0x98BADCFEU, 0x10325476U};
  std::array<std::uint8_t, 64> rest_ = {};
  std::uint64_t length_ = 0;
};

/// Returns the digest of complete data.
[[nodiscard]] Sum digest_of(DigestAlgorithm algorithm, std::string_view data);

}  // namespace fc_runtime
