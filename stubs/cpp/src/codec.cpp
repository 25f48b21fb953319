#include "fc_runtime/codec.hpp"

#include <algorithm>
#include <map>
#include <mutex>

#include "pattern.hpp"

namespace fc_runtime {

std::string to_string(const ConditionError& error) {
  return "`" + error.path + "` " + (error.is_missing ? "is missing" : "is not asked for") +
         ": it is sent " + error.condition;
}

namespace detail {

namespace {

/// Returns `true` if the text as a whole is not JSON. This error takes precedence over all others.
bool is_broken(std::string_view text, const Allowance& allowance, BodyError& error) {
  switch (error.kind) {
    case BodyErrorKind::BadJson:
    case BodyErrorKind::TooDeep:
    case BodyErrorKind::TooManyValues:
    case BodyErrorKind::ListsTooLarge:
      return false;
    default:
      break;
  }
  BodyError found;
  if (is_json(text, allowance, found)) return false;
  if (found.kind != BodyErrorKind::BadJson && found.kind != BodyErrorKind::TooDeep) return false;
  error = std::move(found);
  return true;
}

}  // namespace

std::size_t characters(std::string_view text) {
  const auto is_first = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), is_first));
}

bool matches(std::string_view text, std::string_view pattern) {
  static std::mutex lock;
  static std::map<std::string, const Pattern, std::less<>> compiled;
  const Pattern* found = nullptr;
  {
    const std::lock_guard<std::mutex> held(lock);
    auto known = compiled.find(pattern);
    if (known == compiled.end()) {
      known = compiled.try_emplace(std::string(pattern), pattern).first;
    }
    // The addresses of map entries are stable.
    found = &known->second;
  }
  return found->matches(text);
}

bool read_zero_or_one(Reader& reader, bool& out) {
  reader.peek();
  const std::size_t start = reader.offset();
  std::uint64_t value = 0;
  if (!reader.integer(value) || value > 1) {
    return reader.fail(BodyErrorKind::WrongType, start, "send 0 or 1");
  }
  out = value == 1;
  return true;
}

bool read_bool(Reader& reader, const Field& field, bool& out) {
  const char next = reader.peek();
  const std::size_t start = reader.offset();
  const bool takes_any = field.is_lenient_bool();
  if (next == '"') {
    if (!takes_any && !field.is_quoted()) return reader.unexpected("true or false");
    std::string_view text;
    if (!reader.text(text)) return false;
    out = text == "true";
    return out || text == "false" ||
           reader.fail(BodyErrorKind::WrongType, start, "send \"true\" or \"false\"");
  }
  if (next == '-' || (next >= '0' && next <= '9')) {
    if (!takes_any && !field.is_numeric()) return reader.unexpected("true or false");
    return read_zero_or_one(reader, out);
  }
  if (!takes_any && (field.is_quoted() || field.is_numeric())) {
    return reader.unexpected(field.is_quoted() ? "a bool as a string" : "0 or 1");
  }
  return reader.boolean(out);
}

bool read_number_text(Reader& reader, const Field& field, std::string& out, std::size_t& start) {
  reader.peek();
  start = reader.offset();
  if (!reader.string(out)) return false;
  const bool is_hex = out.size() > 2 && out[0] == '0' && (out[1] == 'x' || out[1] == 'X');
  if (is_hex && field.is_lenient_number()) {
    std::uint64_t value = 0;
    bool is_beyond = false;
    for (std::size_t at = 2; at < out.size(); ++at) {
      const char c = out[at];
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) return reader.fail(BodyErrorKind::WrongType, start, "send a number");
      is_beyond = is_beyond || value >> 60U != 0;
      value = value << 4U | static_cast<std::uint64_t>(digit);
    }
    // Invalid digits take precedence: with them, the string is not a number at all.
    if (is_beyond) {
      return reader.fail(BodyErrorKind::OutOfRange, start, "the number is too large");
    }
    out = std::to_string(value);
  }
  // A string that is not a number has the wrong type. White space is not allowed either.
  const char first = out.empty() ? ' ' : out.front();
  return first == '-' || (first >= '0' && first <= '9') ||
         reader.fail(BodyErrorKind::WrongType, start, "the string does not hold a number");
}

bool choose(Reader& reader, const std::vector<RequiredKeys>& variants, std::size_t& chosen) {
  if (reader.peek() != '{') return reader.unexpected("an object");
  const std::size_t start = reader.offset();
  Reader ahead = reader;
  // The required fields of each variant that were found.
  std::vector<std::vector<bool>> present;
  present.reserve(variants.size());
  for (const auto& variant : variants) present.emplace_back(variant.size());
  if (!ahead.begin_object()) {
    reader = ahead;
    return false;
  }
  while (!ahead.end_object()) {
    std::string_view key;
    if (!ahead.key(key)) {
      reader = ahead;
      return false;
    }
    for (std::size_t variant = 0; variant < variants.size(); ++variant) {
      for (std::size_t field = 0; field < variants[variant].size(); ++field) {
        const auto& names = variants[variant][field];
        if (std::find(names.begin(), names.end(), key) != names.end()) {
          present[variant][field] = true;
        }
      }
    }
    if (!ahead.count(1) || !ahead.skip() || !ahead.end_value()) {
      reader = ahead;
      return false;
    }
  }
  for (std::size_t variant = 0; variant < variants.size(); ++variant) {
    const auto& has = present[variant];
    if (std::find(has.begin(), has.end(), false) == has.end()) {
      chosen = variant;
      return true;
    }
  }
  return reader.fail(BodyErrorKind::NoVariant, start, "none of the forms has all of its keys");
}

bool read_object(std::string_view text, const Allowance& allowance, ReadInto read, void* out,
                 Beside* beside, BodyError& error) {
  if (!is_utf8(text)) {
    error = BodyError{BodyErrorKind::NotUtf8, "", 0, "send UTF-8"};
    return false;
  }
  // An empty body means an object without keys.
  if (text.empty()) text = "{}";
  Reader reader(text, allowance);
  if (reader.peek() != '{') {
    const std::size_t start = reader.offset();
    error = BodyError{BodyErrorKind::NotAnObject, "", start, "send an object"};
    BodyError found;
    if (!is_json(text, allowance, found)) error = std::move(found);
    return false;
  }
  if (read(reader, out, beside) && reader.finish()) return true;
  error = reader.take_error();
  is_broken(text, allowance, error);
  // An error of the JSON syntax has an offset in the text, but no path in the message.
  if (error.kind == BodyErrorKind::BadJson || error.kind == BodyErrorKind::TooDeep) {
    error.path.clear();
  }
  return false;
}

bool write_object(const void* message, WriteFrom write, std::string& out, BodyError& error) {
  Writer writer(out);
  write(writer, message);
  if (!writer.has_failed()) return true;
  error = writer.take_error();
  return false;
}

}  // namespace detail

}  // namespace fc_runtime
