#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fc_runtime/reader.hpp"

namespace fc_runtime {

bool is_utf8(std::string_view bytes) noexcept {
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto* const end = at + bytes.size();
  while (at < end) {
    if (end - at >= 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, at, sizeof eight);
      if ((eight & 0x8080808080808080U) == 0) {
        at += 8;
        continue;
      }
    }
    const unsigned first = *at;
    if (first < 0x80U) {
      ++at;
      continue;
    }
    std::ptrdiff_t more = 0;
    std::uint32_t least = 0;
    if (first >= 0xC2U && first <= 0xDFU) {
      more = 1;
      least = 0x80U;
    } else if (first >= 0xE0U && first <= 0xEFU) {
      more = 2;
      least = 0x800U;
    } else if (first >= 0xF0U && first <= 0xF4U) {
      more = 3;
      least = 0x10000U;
    } else {
      return false;
    }
    if (end - at <= more) return false;
    std::uint32_t point = first & (0x3FU >> static_cast<unsigned>(more));
    for (std::ptrdiff_t index = 1; index <= more; ++index) {
      const unsigned byte = at[index];
      if ((byte & 0xC0U) != 0x80U) return false;
      point = (point << 6U) | (byte & 0x3FU);
    }
    if (point < least || point > 0x10FFFFU || (point >= 0xD800U && point <= 0xDFFFU)) return false;
    at += more + 1;
  }
  return true;
}

}  // namespace fc_runtime
