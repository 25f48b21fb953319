// How the header of a frame says that its data has arrived undamaged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fc_runtime {

/// How data is digested. It guards against damage on the way, not against anybody's intent.
enum class DigestAlgorithm {
  None,   ///< Not at all: damage is left to TCP and to the parser.
  Crc32,  ///< CRC-32 as in gzip; most significant byte first.
  Md5,    ///< MD5 (RFC 1321).
};

/// Room for the longest digest. A shorter one takes the first bytes, and zeros follow.
using Sum = std::array<std::uint8_t, 16>;

/// MD5 (RFC 1321) of data that comes in pieces.
class Md5 {
 public:
  /// Takes in more data.
  void update(std::string_view data);
  /// The digest of all that was taken in. Nothing may follow.
  [[nodiscard]] Sum finish();

 private:
  void block(const std::uint8_t* bytes);

  std::array<std::uint32_t, 4> state_ = {0x67452301U, 0xEFCDAB89U, 0x98BADCFEU, 0x10325476U};
  std::array<std::uint8_t, 64> rest_ = {};
  std::uint64_t length_ = 0;
};

/// The digest of data as a whole.
[[nodiscard]] Sum digest_of(DigestAlgorithm algorithm, std::string_view data);

}  // namespace fc_runtime
