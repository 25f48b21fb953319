#include "fc_runtime/writer.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace fc_runtime {

void Writer::string(std::string_view text) {
  out_.push_back('"');
  std::size_t start = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char next = text[at];
    if (static_cast<unsigned char>(next) >= 0x20U && next != '"' && next != '\\') continue;
    out_.append(text, start, at - start);
    start = at + 1;
    switch (next) {
      case '"':
        out_.append("\\\"");
        break;
      case '\\':
        out_.append("\\\\");
        break;
      case '\b':
        out_.append("\\b");
        break;
      case '\f':
        out_.append("\\f");
        break;
      case '\n':
        out_.append("\\n");
        break;
      case '\r':
        out_.append("\\r");
        break;
      case '\t':
        out_.append("\\t");
        break;
      default: {
        constexpr std::string_view kHex = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(next);
        out_.append("\\u00");
        out_.push_back(kHex[byte >> 4U]);
        out_.push_back(kHex[byte & 0xFU]);
      }
    }
  }
  out_.append(text, start, text.size() - start);
  out_.push_back('"');
}

void Writer::signed_integer(std::int64_t value) {
  std::array<char, 24> room{};
  const auto end = std::to_chars(room.data(), room.data() + room.size(), value);
  out_.append(room.data(), end.ptr);
}

void Writer::unsigned_integer(std::uint64_t value) {
  std::array<char, 24> room{};
  const auto end = std::to_chars(room.data(), room.data() + room.size(), value);
  out_.append(room.data(), end.ptr);
}

namespace {

/// Appends the result of `float_text`.
template <class Float>
void append_float(std::string& out, Float value) {
  std::array<char, 64> room{};
  const auto size = static_cast<double>(std::fabs(value));
  const bool is_moderate = size == 0 || (size >= 1e-5 && size < 1e16);
  const auto format = is_moderate ? std::chars_format::fixed : std::chars_format::scientific;
  const auto end = std::to_chars(room.data(), room.data() + room.size(), value, format);
  const std::string_view text(room.data(), static_cast<std::size_t>(end.ptr - room.data()));
  out.append(text);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string_view::npos) out.append(".0");
}

}  // namespace

std::string float_text(double value) {
  std::string text;
  append_float(text, value);
  return text;
}

std::string float_text(float value) {
  std::string text;
  append_float(text, value);
  return text;
}

void Writer::float64(double value) {
  if (!std::isfinite(value)) {
    fail(BodyErrorKind::OutOfRange, "JSON has no number for this value");
    return;
  }
  append_float(out_, value);
}

void Writer::float32(float value) {
  if (!std::isfinite(value)) {
    fail(BodyErrorKind::OutOfRange, "JSON has no number for this value");
    return;
  }
  append_float(out_, value);
}

void Writer::base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  out_.push_back('"');
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t here = bytes.size() - at < 3 ? bytes.size() - at : 3;
    std::uint32_t bits = 0;
    for (std::size_t index = 0; index < 3; ++index) {
      bits <<= 8U;
      if (index < here) bits |= static_cast<unsigned char>(bytes[at + index]);
    }
    for (std::size_t index = 0; index < 4; ++index) {
      const auto digit = bits >> (18U - 6U * static_cast<unsigned>(index)) & 0x3FU;
      out_.push_back(index <= here ? kDigits[digit] : '=');
    }
  }
  out_.push_back('"');
}

void Writer::extra(const Extra& extra, bool first) {
  std::string_view members = extra.text_;
  if (first && !members.empty()) members.remove_prefix(1);
  out_.append(members);
}

void Writer::fail(BodyErrorKind kind, std::string_view detail) {
  if (failed_) return;
  failed_ = true;
  error_.kind = kind;
  error_.detail = detail;
}

void Writer::in_key(std::string_view key) {
  std::string& path = error_.path;
  if (!path.empty() && path.front() != '[') path.insert(path.begin(), '.');
  path.insert(0, key);
}

void Writer::in_item(std::size_t index) {
  std::string& path = error_.path;
  if (!path.empty() && path.front() != '[') path.insert(path.begin(), '.');
  path.insert(0, "[" + std::to_string(index) + "]");
}

}  // namespace fc_runtime
