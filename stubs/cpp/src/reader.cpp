#include "fc_runtime/reader.hpp"

#include <cstring>

namespace fc_runtime {

namespace {

/// Appends a code point as UTF-8.
void append_utf8(std::string& out, std::uint32_t point) {
  const auto push = [&out](std::uint32_t byte) { out.push_back(static_cast<char>(byte & 0xFFU)); };
  if (point < 0x80U) {
    push(point);
  } else if (point < 0x800U) {
    push(0xC0U | (point >> 6U));
    push(0x80U | (point & 0x3FU));
  } else if (point < 0x10000U) {
    push(0xE0U | (point >> 12U));
    push(0x80U | ((point >> 6U) & 0x3FU));
    push(0x80U | (point & 0x3FU));
  } else {
    push(0xF0U | (point >> 18U));
    push(0x80U | ((point >> 12U) & 0x3FU));
    push(0x80U | ((point >> 6U) & 0x3FU));
    push(0x80U | (point & 0x3FU));
  }
}

}  // namespace

bool is_json(std::string_view text, const Allowance& allowance, BodyError& error) {
  Reader reader(text, allowance);
  if (reader.skip() && reader.finish()) return true;
  error = reader.take_error();
  return false;
}

// ---- errors ----

bool Reader::fail(BodyErrorKind kind, std::size_t offset, std::string_view detail) {
  error_.kind = kind;
  error_.offset = offset;
  error_.detail = detail;
  error_.path.clear();
  return false;
}

bool Reader::unexpected(std::string_view wanted) {
  const std::size_t start = at_;
  peek();
  const std::size_t place = at_;
  if (!skip()) return false;
  at_ = start;
  return fail(BodyErrorKind::WrongType, place, "send " + std::string(wanted));
}

bool Reader::in_key(std::string_view key) {
  std::string& path = error_.path;
  if (!path.empty() && path.front() != '[') path.insert(path.begin(), '.');
  path.insert(0, key);
  return false;
}

bool Reader::in_item(std::size_t index) {
  std::string& path = error_.path;
  if (!path.empty() && path.front() != '[') path.insert(path.begin(), '.');
  path.insert(0, "[" + std::to_string(index) + "]");
  return false;
}

// ---- objects and lists ----

bool Reader::enter() {
  if (depth_ == 0) return fail_here(BodyErrorKind::TooDeep, "nested deeper than the limit");
  --depth_;
  ++at_;
  return true;
}

bool Reader::begin_object() {
  if (peek() != '{') return unexpected("an object");
  if (!enter()) return false;
  const char next = peek();
  return next == '"' || next == '}' || bad_json("a key in quotes or `}` is expected here");
}

bool Reader::end_object() {
  if (peek() != '}') return false;
  leave();
  return true;
}

bool Reader::key(std::string_view& out) {
  peek();
  const std::size_t start = at_;
  if (!text(out)) return false;
  raw_key_ = since(start);
  if (peek() != ':') return bad_json("`:` is expected after a key");
  ++at_;
  return true;
}

bool Reader::end_value() {
  switch (peek()) {
    case ',':
      ++at_;
      return peek() == '"' || bad_json("a key in quotes is expected after `,`");
    case '}':
      return true;
    default:
      return bad_json("`,` or `}` is expected after a value");
  }
}

bool Reader::begin_list() {
  if (peek() != '[') return unexpected("a list");
  return enter();
}

bool Reader::end_list() {
  if (peek() != ']') return false;
  leave();
  return true;
}

bool Reader::next_item(bool& more) {
  switch (peek()) {
    case ',':
      ++at_;
      more = true;
      return true;
    case ']':
      leave();
      more = false;
      return true;
    default:
      return bad_json("`,` or `]` is expected after an item");
  }
}

bool Reader::count(std::size_t values) {
  if (values > values_) {
    return fail_here(BodyErrorKind::TooManyValues, "more keys and items than the limit");
  }
  values_ -= values;
  return true;
}

bool Reader::pay(std::size_t bytes) {
  if (bytes > lists_) {
    return fail_here(BodyErrorKind::ListsTooLarge, "the lists take more memory than the limit");
  }
  lists_ -= bytes;
  return true;
}

// ---- values ----

bool Reader::skip_word(std::string_view word) {
  if (text_.substr(at_, word.size()) != word) return bad_json("a value is expected here");
  at_ += word.size();
  return true;
}

bool Reader::boolean(bool& out) {
  const char next = peek();
  if (next != 't' && next != 'f') return unexpected("true or false");
  out = next == 't';
  return skip_word(out ? "true" : "false");
}

bool Reader::take_null() {
  if (peek() != 'n' || text_.substr(at_, 4) != "null") return false;
  at_ += 4;
  return true;
}

bool Reader::take_empty() {
  const std::size_t start = at_;
  switch (peek()) {
    case 'n':
      return take_null();
    case '"':
      if (text_.substr(at_, 2) == "\"\"") {
        at_ += 2;
        return true;
      }
      return false;
    case '{':
    case '[': {
      const char close = text_[at_] == '{' ? '}' : ']';
      ++at_;
      if (depth_ > 0 && peek() == close) {
        ++at_;
        return true;
      }
      at_ = start;
      return false;
    }
    default:
      return false;
  }
}

bool Reader::hex4(std::uint32_t& out) {
  out = 0;
  for (int index = 0; index < 4; ++index) {
    const char digit = at_ < text_.size() ? text_[at_] : '\0';
    std::uint32_t value = 0;
    if (is_digit(digit)) {
      value = static_cast<std::uint32_t>(digit - '0');
    } else if (digit >= 'a' && digit <= 'f') {
      value = static_cast<std::uint32_t>(digit - 'a') + 10U;
    } else if (digit >= 'A' && digit <= 'F') {
      value = static_cast<std::uint32_t>(digit - 'A') + 10U;
    } else {
      return bad_json("four hex digits are expected after `\\u`");
    }
    out = out * 16U + value;
    ++at_;
  }
  return true;
}

bool Reader::escape(std::string& out) {
  const std::size_t start = at_;
  ++at_;
  const char letter = at_ < text_.size() ? text_[at_] : '\0';
  ++at_;
  switch (letter) {
    case '"':
    case '\\':
    case '/':
      out.push_back(letter);
      return true;
    case 'b':
      out.push_back('\b');
      return true;
    case 'f':
      out.push_back('\f');
      return true;
    case 'n':
      out.push_back('\n');
      return true;
    case 'r':
      out.push_back('\r');
      return true;
    case 't':
      out.push_back('\t');
      return true;
    case 'u':
      break;
    default:
      at_ = start;
      return bad_json("unknown escape");
  }
  std::uint32_t point = 0;
  if (!hex4(point)) return false;
  if (point >= 0xD800U && point <= 0xDFFFU) {
    std::uint32_t second = 0;
    const bool is_pair = point < 0xDC00U && text_.substr(at_, 2) == "\\u";
    if (is_pair) {
      at_ += 2;
      if (!hex4(second)) return false;
    }
    if (second < 0xDC00U || second > 0xDFFFU) {
      return fail(BodyErrorKind::LoneSurrogate, start, "half of a surrogate pair is no text");
    }
    point = 0x10000U + ((point - 0xD800U) << 10U) + (second - 0xDC00U);
  }
  append_utf8(out, point);
  return true;
}

bool Reader::text(std::string_view& out) {
  if (peek() != '"') return unexpected("a string");
  const std::size_t start = ++at_;
  bool is_plain = true;
  while (at_ < text_.size()) {
    const char next = text_[at_];
    if (next == '"') {
      if (is_plain) {
        out = since(start);
      } else {
        out = buffer_;
      }
      ++at_;
      return true;
    }
    if (static_cast<unsigned char>(next) < 0x20U) return bad_json("control character in a string");
    if (next == '\\') {
      if (is_plain) {
        buffer_.assign(since(start));
        is_plain = false;
      }
      if (!escape(buffer_)) return false;
    } else {
      if (!is_plain) buffer_.push_back(next);
      ++at_;
    }
  }
  return bad_json("the string does not end");
}

bool Reader::string(std::string& out) {
  std::string_view view;
  if (!text(view)) return false;
  out.assign(view);
  return true;
}

bool Reader::skip_string() {
  ++at_;
  while (at_ < text_.size()) {
    const char next = text_[at_];
    if (next == '"') {
      ++at_;
      return true;
    }
    if (static_cast<unsigned char>(next) < 0x20U) return bad_json("control character in a string");
    ++at_;
    if (next != '\\') continue;
    const char letter = at_ < text_.size() ? text_[at_] : '\0';
    ++at_;
    if (letter == 'u') {
      std::uint32_t ignored = 0;
      if (!hex4(ignored)) return false;
    } else if (letter == '\0' || std::strchr("\"\\/bfnrt", letter) == nullptr) {
      --at_;
      return bad_json("unknown escape");
    }
  }
  return bad_json("the string does not end");
}

bool Reader::skip() {
  switch (peek()) {
    case '{': {
      if (!begin_object()) return false;
      while (!end_object()) {
        if (!count(1) || !skip_string()) return false;
        if (peek() != ':') return bad_json("`:` is expected after a key");
        ++at_;
        if (!skip() || !end_value()) return false;
      }
      return true;
    }
    case '[': {
      if (!begin_list()) return false;
      if (end_list()) return true;
      bool more = true;
      while (more) {
        if (!count(1) || !skip() || !next_item(more)) return false;
      }
      return true;
    }
    case '"':
      return skip_string();
    case 't':
      return skip_word("true");
    case 'f':
      return skip_word("false");
    case 'n':
      return skip_word("null");
    case '-':
    case '0':
    case '1':
    case '2':
    case '3':
    case '4':
    case '5':
    case '6':
    case '7':
    case '8':
    case '9':
      return skip_number();
    default:
      return bad_json("a value is expected here");
  }
}

bool Reader::json(Json& out) {
  peek();
  const std::size_t start = at_;
  if (!skip()) return false;
  out.text_.assign(since(start));
  return true;
}

bool Reader::keep(Extra& extra) {
  const std::string_view key = raw_key_;
  peek();
  const std::size_t start = at_;
  if (!skip()) return false;
  extra.append(key, since(start));
  return true;
}

bool Reader::base64(std::string& out) {
  peek();
  const std::size_t start = at_;
  std::string_view text;
  if (!this->text(text)) return false;
  const auto bad = [&] {
    return fail(BodyErrorKind::BadBase64, start, "send padded base64 of the standard alphabet");
  };
  if (text.size() % 4 != 0) return bad();
  const auto value_of = [](char c) -> int {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (is_digit(c)) return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
  };
  out.clear();
  out.reserve(text.size() / 4 * 3);
  for (std::size_t at = 0; at < text.size(); at += 4) {
    const bool is_last = at + 4 == text.size();
    const int padding = is_last && text[at + 3] == '=' ? (text[at + 2] == '=' ? 2 : 1) : 0;
    std::uint32_t bits = 0;
    for (std::size_t index = 0; index < 4; ++index) {
      const bool is_padding = static_cast<int>(index) >= 4 - padding;
      const int value = is_padding ? 0 : value_of(text[at + index]);
      if (value < 0) return bad();
      bits = bits << 6U | static_cast<std::uint32_t>(value);
    }
    // The unused bits must be zero, so that each byte array has exactly one encoding.
    if ((padding == 1 && (bits & 0xFFU) != 0) || (padding == 2 && (bits & 0xFFFFU) != 0)) {
      return bad();
    }
    out.push_back(static_cast<char>(bits >> 16U & 0xFFU));
    if (padding < 2) out.push_back(static_cast<char>(bits >> 8U & 0xFFU));
    if (padding < 1) out.push_back(static_cast<char>(bits & 0xFFU));
  }
  return true;
}

bool Reader::finish() {
  peek();
  return at_ == text_.size() || bad_json("text after the value");
}

}  // namespace fc_runtime
