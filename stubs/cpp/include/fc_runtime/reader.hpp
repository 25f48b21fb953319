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

/// A pass over one text. Every function that reads says whether it went well; if it did not, `error()`
/// says why, and nothing else is to be read.
class Reader {
 public:
  Reader(std::string_view text, const Allowance& allowance)
      : text_(text),
        depth_(allowance.depth),
        values_(allowance.values),
        lists_(allowance.list_bytes) {}

  /// The next character that is not white space; 0 at the end.
  char peek() {
    while (at_ < text_.size()) {
      const char next = text_[at_];
      if (next != ' ' && next != '\n' && next != '\t' && next != '\r') return next;
      ++at_;
    }
    return '\0';
  }

  [[nodiscard]] std::size_t offset() const { return at_; }
  /// The text from a place on to where the reader stands.
  [[nodiscard]] std::string_view since(std::size_t start) const {
    return text_.substr(start, at_ - start);
  }

  // Objects and lists.
  [[nodiscard]] bool begin_object();
  /// Whether the object ends here; then it has been left.
  [[nodiscard]] bool end_object();
  /// Reads a key and its colon. The view holds until the next key or string is read.
  [[nodiscard]] bool key(std::string_view& out);
  /// The text of the last key, with its quotes and escapes.
  [[nodiscard]] std::string_view raw_key() const { return raw_key_; }
  /// What follows a value in an object, up to the next key or the brace.
  [[nodiscard]] bool end_value();
  [[nodiscard]] bool begin_list();
  /// Whether the list ends here; only for an empty one.
  [[nodiscard]] bool end_list();
  /// Whether another item comes, in `more`; otherwise the list has been left.
  [[nodiscard]] bool next_item(bool& more);
  /// Counts keys or items.
  [[nodiscard]] bool count(std::size_t values);
  /// Pays for the items of a list.
  [[nodiscard]] bool pay(std::size_t bytes);

  // Values.
  [[nodiscard]] bool boolean(bool& out);
  [[nodiscard]] bool string(std::string& out);
  /// A string that has no escapes is a view into the text, any other into a buffer of the reader.
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
  /// Reads a value and forgets it.
  [[nodiscard]] bool skip();
  /// Reads the value of the last key, which is unknown, and keeps the text of both.
  [[nodiscard]] bool keep(Extra& extra);
  /// Nothing but white space is left.
  [[nodiscard]] bool finish();

  // Faults.
  bool fail(BodyErrorKind kind, std::size_t offset, std::string_view detail);
  bool fail_here(BodyErrorKind kind, std::string_view detail) { return fail(kind, at_, detail); }
  /// The value that comes next is not of the kind that is wanted; or it is not JSON at all.
  bool unexpected(std::string_view wanted);
  bool bad_json(std::string_view detail) { return fail_here(BodyErrorKind::BadJson, detail); }
  /// The fault as seen from the object or list around it; always false.
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

/// Whether a character is one of the ten digits.
[[nodiscard]] constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Whether bytes are UTF-8.
[[nodiscard]] bool is_utf8(std::string_view bytes) noexcept;

/// Whether a text is one JSON value within an allowance; if not, why.
[[nodiscard]] bool is_json(std::string_view text, const Allowance& allowance, BodyError& error);

}  // namespace fc_runtime
