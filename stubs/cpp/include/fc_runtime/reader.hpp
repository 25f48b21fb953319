// Reads JSON text straight into typed fields. Strict, exact and bounded; for generated code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "fc_runtime/error.hpp"
#include "fc_runtime/json.hpp"

namespace fc_runtime {

/// Reads one text in a single pass. The reading functions return `false` on an error. Then
/// `error()` describes it, and no further reads are allowed.
class Reader {
 public:
  Reader(std::string_view text, const Allowance& allowance)
      : text_(text),
        depth_(allowance.depth),
        values_(allowance.values),
        lists_(allowance.list_bytes) {}

  /// Returns the next character other than white space, or 0 at the end.
  char peek() {
    while (at_ < text_.size()) {
      const char next = text_[at_];
      if (next != ' ' && next != '\n' && next != '\t' && next != '\r') return next;
      ++at_;
    }
    return '\0';
  }

  [[nodiscard]] std::size_t offset() const { return at_; }
  /// Returns the text from `start` to the current position.
  [[nodiscard]] std::string_view since(std::size_t start) const {
    return text_.substr(start, at_ - start);
  }

  // Objects and lists.
  [[nodiscard]] bool begin_object();
  /// Returns `true` at the end of the object, and leaves it.
  [[nodiscard]] bool end_object();
  /// Reads a key and its colon. The view is valid until the next key or string is read.
  [[nodiscard]] bool key(std::string_view& out);
  /// The text of the last key, including quotes and escapes.
  [[nodiscard]] std::string_view raw_key() const { return raw_key_; }
  /// Reads from the end of a value up to the next key or the closing brace.
  [[nodiscard]] bool end_value();
  [[nodiscard]] bool begin_list();
  /// Returns `true` if the list is empty, and leaves it. Call it only before the first item.
  [[nodiscard]] bool end_list();
  /// Sets `more` if another item follows. Otherwise leaves the list.
  [[nodiscard]] bool next_item(bool& more);
  /// Counts keys or items against the limit.
  [[nodiscard]] bool count(std::size_t values);
  /// Counts the memory for items of a list against the limit.
  [[nodiscard]] bool pay(std::size_t bytes);

  // Values.
  [[nodiscard]] bool boolean(bool& out);
  [[nodiscard]] bool string(std::string& out);
  /// Returns a view into the text, or into a buffer of the reader if the string has escapes.
  [[nodiscard]] bool text(std::string_view& out);
  [[nodiscard]] bool float64(double& out);
  [[nodiscard]] bool float32(float& out);
  template <class Integer>
  [[nodiscard]] bool integer(Integer& out) {
    std::int64_t whole = 0;
    if constexpr (std::is_signed_v<Integer>) {
      if (!signed_integer(std::numeric_limits<Integer>::min(), std::numeric_limits<Integer>::max(),
                          whole)) {
        return false;
      }
      out = static_cast<Integer>(whole);
    } else {
      std::uint64_t magnitude = 0;
      if (!unsigned_integer(std::numeric_limits<Integer>::max(), magnitude)) return false;
      out = static_cast<Integer>(magnitude);
    }
    return true;
  }
  [[nodiscard]] bool json(Json& out);
  [[nodiscard]] bool base64(std::string& out);
  /// Reads `null` if it comes next.
  [[nodiscard]] bool take_null();
  /// Reads `null`, `{}`, `[]` or `""` if it comes next.
  [[nodiscard]] bool take_empty();
  /// Skips a value.
  [[nodiscard]] bool skip();
  /// Reads the value of the last key and keeps the text of both as unknown.
  [[nodiscard]] bool keep(Extra& extra);
  /// Checks that only white space is left.
  [[nodiscard]] bool finish();

  // Errors.
  bool fail(BodyErrorKind kind, std::size_t offset, std::string_view detail);
  bool fail_here(BodyErrorKind kind, std::string_view detail) { return fail(kind, at_, detail); }
  /// Fails because the next value has the wrong type, or is not JSON.
  bool unexpected(std::string_view wanted);
  bool bad_json(std::string_view detail) { return fail_here(BodyErrorKind::BadJson, detail); }
  /// Prepends a key or index to the path of the error. Always returns `false`.
  bool in_key(std::string_view key);
  bool in_item(std::size_t index);
  [[nodiscard]] const BodyError& error() const { return error_; }
  [[nodiscard]] BodyError take_error() { return std::move(error_); }

 private:
  [[nodiscard]] bool signed_integer(std::int64_t least, std::int64_t most, std::int64_t& out);
  [[nodiscard]] bool unsigned_integer(std::uint64_t most, std::uint64_t& out);
  bool whole_number(bool& negative, std::uint64_t& magnitude, bool& too_large);
  bool skip_number();
  bool skip_digits();
  bool skip_string();
  bool skip_word(std::string_view word);
  bool escape(std::string& out);
  bool hex4(std::uint32_t& out);
  bool enter();
  void leave() {
    ++depth_;
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t depth_;
  std::size_t values_;
  std::size_t lists_;
  std::string buffer_;
  std::string_view raw_key_;
  BodyError error_;
};

/// Returns `true` for an ASCII digit.
[[nodiscard]] constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Returns `true` if `bytes` is UTF-8.
[[nodiscard]] bool is_utf8(std::string_view bytes) noexcept;

/// Returns `true` if a text is one JSON value within the limits. Otherwise sets `error`.
[[nodiscard]] bool is_json(std::string_view text, const Allowance& allowance, BodyError& error);

}  // namespace fc_runtime
