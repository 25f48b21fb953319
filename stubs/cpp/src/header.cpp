// Reads and writes frame headers by their layout, and looks up parts of a protocol.
#include <algorithm>
#include <limits>

#include "fc_runtime/frame.hpp"

namespace fc_runtime {

const HeaderField* HeaderLayout::find(HeaderRole role) const noexcept {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [role](const HeaderField& field) { return field.role == role; });
  return found == fields.end() ? nullptr : &*found;
}

std::uint32_t HeaderLayout::id_max() const noexcept {
  const HeaderField* field = find(HeaderRole::Id);
  const bool is_short = field != nullptr && field->size < 4;
  return is_short ? std::numeric_limits<std::uint16_t>::max()
                  : std::numeric_limits<std::uint32_t>::max();
}

bool Protocol::has_result() const noexcept {
  return std::any_of(response_envelope.begin(), response_envelope.end(),
                     [](const EnvelopeKey& key) { return key.role == EnvelopeRole::ResultCode; });
}

const OperationInfo* Protocol::find(OperationKind kind, std::uint16_t code) const noexcept {
  const auto found = std::find_if(
      operations.begin(), operations.end(),
      [=](const OperationInfo& known) { return known.kind == kind && known.code == code; });
  return found == operations.end() ? nullptr : &*found;
}

namespace detail {

namespace {

std::uint64_t read_integer(const HeaderLayout& layout, const HeaderField& field,
                           std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t at = 0; at < field.size; ++at) {
    const std::size_t place = layout.big_endian ? at : field.size - 1 - at;
    value = value << 8U | static_cast<unsigned char>(bytes[field.offset + place]);
  }
  return value;
}

void write_integer(const HeaderLayout& layout, const HeaderField& field, std::uint64_t value,
                   char* header) {
  for (std::size_t at = 0; at < field.size; ++at) {
    const std::size_t place = layout.big_endian ? field.size - 1 - at : at;
    header[field.offset + place] = static_cast<char>(at < 8 ? value >> (8 * at) & 0xFFU : 0);
  }
}

/// Returns `true` if the digest is an integer with the least significant byte first.
bool is_turned(const HeaderLayout& layout) {
  return layout.digest == DigestAlgorithm::Crc32 && !layout.big_endian;
}

}  // namespace

Header read_header(const Protocol& protocol, std::string_view bytes) {
  Header header;
  header.encoding = protocol.plain_encoding;
  bool has_plain_length = false;
  for (const HeaderField& field : protocol.header.fields) {
    const auto part = bytes.substr(field.offset, field.size);
    const auto number = [&] { return read_integer(protocol.header, field, bytes); };
    switch (field.role) {
      case HeaderRole::Head:
        header.frame.response = part == protocol.response_head;
        break;
      case HeaderRole::Kind:
        header.frame.kind = static_cast<std::uint8_t>(number());
        break;
      case HeaderRole::Code:
        header.frame.code = static_cast<std::uint16_t>(number());
        break;
      case HeaderRole::Id:
        header.frame.id = static_cast<std::uint32_t>(number());
        break;
      case HeaderRole::Encoding:
        header.encoding = static_cast<std::uint8_t>(number());
        break;
      case HeaderRole::TotalLength:
        header.total_length = static_cast<std::uint32_t>(number());
        break;
      case HeaderRole::PlainLength:
        header.plain_length = static_cast<std::uint32_t>(number());
        has_plain_length = true;
        break;
      case HeaderRole::Digest:
        std::copy_n(part.begin(), std::min(part.size(), header.digest.size()),
                    header.digest.begin());
        if (is_turned(protocol.header))
          std::reverse(header.digest.begin(), header.digest.begin() + 4);
        break;
      case HeaderRole::Fixed:
        break;
    }
  }
  if (!has_plain_length) {
    header.plain_length = header.total_length - static_cast<std::uint32_t>(protocol.header.length);
  }
  return header;
}

std::optional<std::uint32_t> peek_total_length(const HeaderLayout& layout, std::string_view bytes) {
  const HeaderField* field = layout.find(HeaderRole::TotalLength);
  if (field == nullptr || bytes.size() < field->offset + field->size) return std::nullopt;
  return static_cast<std::uint32_t>(read_integer(layout, *field, bytes));
}

void write_header(const Protocol& protocol, const Header& header, std::string& out) {
  const std::size_t start = out.size();
  out.resize(start + protocol.header.length);
  char* place = out.data() + start;
  for (const HeaderField& field : protocol.header.fields) {
    const auto integer = [&](std::uint64_t value) {
      write_integer(protocol.header, field, value, place);
    };
    switch (field.role) {
      case HeaderRole::Head: {
        const auto head = header.frame.response ? protocol.response_head : protocol.request_head;
        std::copy_n(head.begin(), std::min(head.size(), field.size), place + field.offset);
        break;
      }
      case HeaderRole::Kind:
        integer(header.frame.kind);
        break;
      case HeaderRole::Code:
        integer(header.frame.code);
        break;
      case HeaderRole::Id:
        integer(header.frame.id);
        break;
      case HeaderRole::Encoding:
        integer(header.encoding);
        break;
      case HeaderRole::TotalLength:
        integer(header.total_length);
        break;
      case HeaderRole::PlainLength:
        integer(header.plain_length);
        break;
      case HeaderRole::Digest:
        std::copy_n(header.digest.begin(), std::min(field.size, header.digest.size()),
                    place + field.offset);
        if (is_turned(protocol.header))
          std::reverse(place + field.offset, place + field.offset + 4);
        break;
      case HeaderRole::Fixed:
        integer(field.value);
        break;
    }
  }
}

}  // namespace detail

}  // namespace fc_runtime
