// JSON as it is kept where no type knows it: as its text, exactly.
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

/// Bytes, as those that travel as base64.
using Bytes = std::vector<std::uint8_t>;

/// What reading one text may cost.
struct Allowance {
  /// Levels of nesting.
  std::size_t depth = 64;
  /// Keys of objects and items of lists, those of all levels together.
  std::size_t values = std::size_t{1} << 20U;
  /// Memory for the items of lists, those of all levels together, in bytes.
  std::size_t list_bytes = std::size_t{32} << 20U;
};

/// A JSON value, kept byte for byte: numbers keep all their digits, strings their escapes, and white
/// space stays. Compared by its text.
class Json {
 public:
  /// `null`.
  Json() : text_("null") {}
  /// Checks a text. White space around it is dropped.
  static Result<Json, BodyError> parse(std::string_view text);
  /// A bool.
  static Json boolean(bool value);
  /// An integer.
  static Json integer(std::int64_t value);
  /// A float; `null` for what JSON has no number for.
  static Json number(double value);
  /// A text.
  static Json string(std::string_view value);

  /// Its text.
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

/// The keys of an object that its type does not know, in the order in which they came, with
/// duplicates. Keys and values are kept byte for byte, and compared so; white space between them is
/// dropped. Kept as one text, so that they cost no more bytes than they were sent with.
class Extra {
 public:
  /// Whether there are none.
  [[nodiscard]] bool empty() const noexcept { return text_.empty(); }
  /// How many there are. Takes a pass over the text.
  [[nodiscard]] std::size_t size() const;
  /// Keys and values in order.
  [[nodiscard]] std::vector<std::pair<std::string, Json>> members() const;
  /// The value of a key; of its last occurrence if it came more than once.
  [[nodiscard]] std::optional<Json> get(std::string_view key) const;
  /// Sets a key, in place of all its former values. A key of the message's own belongs into its
  /// field: here it would be sent twice.
  void set(std::string_view key, const Json& value);
  /// Takes a key out, all of its values.
  void erase(std::string_view key);

  friend bool operator==(const Extra& left, const Extra& right) {
    return left.text_ == right.text_;
  }
  friend bool operator!=(const Extra& left, const Extra& right) { return !(left == right); }

 private:
  friend class Reader;
  friend class Writer;
  /// Appends the texts of a key, with its quotes, and of its value.
  void append(std::string_view key, std::string_view value);
  /// Replaces all values of a key by one, or removes them if `value` is null.
  void replace(std::string_view key, const Json* value);
  /// The members as they are written, each with a comma in front.
  std::string text_;
};

}  // namespace fc_runtime
