// Untyped JSON, kept exactly as its text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fc_runtime/error.hpp"
#include "fc_runtime/result.hpp"

namespace fc_runtime {

/// Bytes, as sent in base64.
using Bytes = std::vector<std::uint8_t>;

/// Limits for reading one JSON text.
struct Allowance {
  /// Deepest nesting.
  std::size_t depth = 64;
  /// Most keys of objects and items of lists, over all levels.
  std::size_t values = std::size_t{1} << 20U;
  /// Most memory for the items of lists, over all levels, in bytes.
  std::size_t list_bytes = std::size_t{32} << 20U;
};

/// A JSON value, kept byte for byte: digits, escapes and white space are unchanged. Comparison is
/// by text.
class Json {
 public:
  /// `null`.
  Json() : text_("null") {}
  /// Parses a text. White space around the value is dropped.
  static Result<Json, BodyError> parse(std::string_view text);
  /// Returns a bool.
  static Json boolean(bool value);
  /// Returns an integer.
  static Json integer(std::int64_t value);
  /// Returns a float, or `null` if JSON cannot represent it.
  static Json number(double value);
  /// Returns a string.
  static Json string(std::string_view value);

  /// The JSON text.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  friend bool operator==(const Json& left, const Json& right) { return left.text_ == right.text_; }
  friend bool operator!=(const Json& left, const Json& right) { return !(left == right); }
  friend std::ostream& operator<<(std::ostream& out, const Json& value);

 private:
  friend class Extra;
  friend class Reader;
  explicit Json(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// The unknown keys of an object, in the order received, with duplicates. Keys and values are kept
/// and compared byte for byte; white space between them is dropped. One string holds them all, so
/// that they take no more memory than on the wire.
class Extra {
 public:
  /// Returns `true` if there are no keys.
  [[nodiscard]] bool empty() const noexcept { return text_.empty(); }
  /// Returns the number of keys. Scans the text.
  [[nodiscard]] std::size_t size() const;
  /// Returns the keys and values in order.
  [[nodiscard]] std::vector<std::pair<std::string, Json>> members() const;
  /// Returns the value of a key, or the last one of a repeated key.
  [[nodiscard]] std::optional<Json> get(std::string_view key) const;
  /// Sets a key and removes all its previous values. Set the known keys of a message in its fields;
  /// here they would be sent twice.
  void set(std::string_view key, const Json& value);
  /// Removes all values of a key.
  void erase(std::string_view key);

  friend bool operator==(const Extra& left, const Extra& right) {
    return left.text_ == right.text_;
  }
  friend bool operator!=(const Extra& left, const Extra& right) { return !(left == right); }

 private:
  friend class Reader;
  friend class Writer;
  /// Appends a key, as quoted text, and the text of its value.
  void append(std::string_view key, std::string_view value);
  /// Replaces all values of a key by one, or removes them if `value` is null.
  void replace(std::string_view key, const Json* value);
  /// The members as sent, each with a leading comma.
  std::string text_;
};

}  // namespace fc_runtime
