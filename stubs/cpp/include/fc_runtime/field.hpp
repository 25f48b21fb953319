// The wire format and constraints of a field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace fc_runtime {

/// The smallest or largest value of a number.
class Limit {
 public:
  constexpr Limit() = default;

  template <class Number>
  static constexpr Limit of(Number value) {
    Limit limit;
    limit.is_set_ = true;
    if constexpr (std::is_floating_point_v<Number>) {
      limit.is_float_ = true;
      limit.float_ = value;
    } else {
      limit.negative_ = value < Number{0};
      const auto bits = static_cast<std::uint64_t>(value);
      limit.magnitude_ = limit.negative_ ? ~bits + 1U : bits;
    }
    return limit;
  }

  [[nodiscard]] constexpr bool is_set() const { return is_set_; }

  /// Returns `true` if a number is less than this limit.
  template <class Number>
  [[nodiscard]] bool above(Number value) const {
    if constexpr (std::is_floating_point_v<Number>) {
      return !(static_cast<double>(value) >= as_float());
    } else {
      return is_float_ ? !(static_cast<double>(value) >= float_) : compare(value) < 0;
    }
  }

  /// Returns `true` if a number is greater than this limit.
  template <class Number>
  [[nodiscard]] bool below(Number value) const {
    if constexpr (std::is_floating_point_v<Number>) {
      return !(static_cast<double>(value) <= as_float());
    } else {
      return is_float_ ? !(static_cast<double>(value) <= float_) : compare(value) > 0;
    }
  }

 private:
  [[nodiscard]] double as_float() const {
    if (is_float_) return float_;
    const auto magnitude = static_cast<double>(magnitude_);
    return negative_ ? -magnitude : magnitude;
  }

  template <class Integer>
  [[nodiscard]] int compare(Integer value) const {
    bool negative = false;
    if constexpr (std::is_signed_v<Integer>) negative = value < 0;
    if (negative != negative_) return negative ? -1 : 1;
    const auto bits = static_cast<std::uint64_t>(value);
    const std::uint64_t magnitude = negative ? ~bits + 1U : bits;
    if (magnitude == magnitude_) return 0;
    return (magnitude < magnitude_) != negative ? -1 : 1;
  }

  bool is_set_ = false;
  bool is_float_ = false;
  bool negative_ = false;
  std::uint64_t magnitude_ = 0;
  double float_ = 0;
};

/// A field of a message, as visitors of the message see it.
class Field {
 public:
  constexpr explicit Field(std::string_view key) : key_(key) {}

  /// Other keys that are read into this field.
  template <std::size_t N>
  constexpr Field also(const std::string_view (&keys)[N]) const {
    Field field = *this;
    field.also_ = keys;
    field.also_count_ = N;
    return field;
  }
  /// A number or bool that travels inside a string.
  constexpr Field quoted() const { return with(&Field::quoted_); }
  /// A bool that travels as 1 or 0.
  constexpr Field numeric() const { return with(&Field::numeric_); }
  /// A number that is also read from a decimal or `0x` string.
  constexpr Field lenient_number() const { return with(&Field::lenient_number_); }
  /// A bool that is also read from its string, and from 1 and 0.
  constexpr Field lenient_bool() const { return with(&Field::lenient_bool_); }
  /// Reads `{}`, `[]` and `""` as an absent value, like `null`.
  constexpr Field empty_is_absent() const { return with(&Field::empty_is_absent_); }
  /// Bytes that travel as base64.
  constexpr Field base64() const { return with(&Field::base64_); }
  /// Never printed.
  constexpr Field sensitive() const { return with(&Field::sensitive_); }
  /// Smallest value of a number.
  template <class Number>
  constexpr Field min(Number value) const {
    Field field = *this;
    field.min_ = Limit::of(value);
    return field;
  }
  /// Largest value of a number.
  template <class Number>
  constexpr Field max(Number value) const {
    Field field = *this;
    field.max_ = Limit::of(value);
    return field;
  }
  /// Least and most characters of a string, bytes of base64 data, or items of a list.
  constexpr Field length(std::uint64_t least, std::uint64_t most) const {
    Field field = *this;
    field.has_length_ = true;
    field.least_ = least;
    field.most_ = most;
    return field;
  }
  /// A regular expression that a string must match as a whole.
  constexpr Field pattern(std::string_view source) const {
    Field field = *this;
    field.pattern_ = source;
    return field;
  }
  /// The allowed values of an enum, as numbers.
  template <std::size_t N>
  constexpr Field only(const std::int64_t (&values)[N]) const {
    Field field = *this;
    field.only_numbers_ = values;
    field.only_count_ = N;
    return field;
  }
  /// The allowed values of an enum, as strings.
  template <std::size_t N>
  constexpr Field only(const std::string_view (&values)[N]) const {
    Field field = *this;
    field.only_texts_ = values;
    field.only_count_ = N;
    return field;
  }

  [[nodiscard]] constexpr std::string_view key() const { return key_; }
  [[nodiscard]] constexpr bool is_quoted() const { return quoted_; }
  [[nodiscard]] constexpr bool is_numeric() const { return numeric_; }
  [[nodiscard]] constexpr bool is_lenient_number() const { return lenient_number_; }
  [[nodiscard]] constexpr bool is_lenient_bool() const { return lenient_bool_; }
  [[nodiscard]] constexpr bool is_empty_absent() const { return empty_is_absent_; }
  [[nodiscard]] constexpr bool is_base64() const { return base64_; }
  [[nodiscard]] constexpr bool is_sensitive() const { return sensitive_; }
  [[nodiscard]] constexpr std::string_view pattern_source() const { return pattern_; }
  [[nodiscard]] constexpr bool has_length() const { return has_length_; }
  [[nodiscard]] constexpr bool has_only() const { return only_count_ > 0; }

  /// Returns `true` if a key belongs to this field.
  [[nodiscard]] constexpr bool is_called(std::string_view key) const {
    return key == key_ || name_of(key).data() != key_.data();
  }
  /// Returns the equal key of this field, which outlives the text that was read. Returns the main
  /// key if none is equal.
  [[nodiscard]] constexpr std::string_view name_of(std::string_view key) const {
    for (std::size_t index = 0; index < also_count_; ++index) {
      if (key == also_[index]) return also_[index];
    }
    return key_;
  }
  /// The other keys that are read into this field.
  [[nodiscard]] constexpr std::size_t also_count() const { return also_count_; }
  [[nodiscard]] constexpr std::string_view also_at(std::size_t index) const { return also_[index]; }

  /// Returns the reason why the field refuses a number, or an empty string if it accepts it.
  template <class Number>
  [[nodiscard]] std::string_view number_fault(Number value) const {
    if (min_.is_set() && min_.above(value)) return "the number is too small";
    if (max_.is_set() && max_.below(value)) return "the number is too large";
    return {};
  }
  [[nodiscard]] constexpr bool takes_length(std::uint64_t length) const {
    return !has_length_ || (length >= least_ && length <= most_);
  }
  [[nodiscard]] constexpr bool takes(std::int64_t value) const {
    for (std::size_t index = 0; index < only_count_; ++index) {
      if (only_numbers_ != nullptr && only_numbers_[index] == value) return true;
    }
    return only_count_ == 0;
  }
  [[nodiscard]] constexpr bool takes(std::string_view value) const {
    for (std::size_t index = 0; index < only_count_; ++index) {
      if (only_texts_ != nullptr && only_texts_[index] == value) return true;
    }
    return only_count_ == 0;
  }

 private:
  constexpr Field with(bool Field::*flag) const {
    Field field = *this;
    field.*flag = true;
    return field;
  }

  std::string_view key_;
  const std::string_view* also_ = nullptr;
  std::size_t also_count_ = 0;
  bool quoted_ = false;
  bool numeric_ = false;
  bool lenient_number_ = false;
  bool lenient_bool_ = false;
  bool empty_is_absent_ = false;
  bool base64_ = false;
  bool sensitive_ = false;
  bool has_length_ = false;
  std::uint64_t least_ = 0;
  std::uint64_t most_ = 0;
  Limit min_;
  Limit max_;
  std::string_view pattern_;
  const std::int64_t* only_numbers_ = nullptr;
  const std::string_view* only_texts_ = nullptr;
  std::size_t only_count_ = 0;
};

}  // namespace fc_runtime
