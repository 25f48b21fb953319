// Reads a value of any type and checks the constraints of its field. For codec.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "fc_runtime/field.hpp"
#include "fc_runtime/id.hpp"
#include "fc_runtime/message.hpp"
#include "fc_runtime/reader.hpp"
#include "fc_runtime/required.hpp"
#include "fc_runtime/writer.hpp"

namespace fc_runtime {

/// The fields of a message. The generated code specializes it; `each(visit, message)` visits them
/// all.
template <class T>
struct Fields;

/// A value of an enum.
template <class Wire>
struct EnumValue {
  /// The value on the wire.
  Wire wire;
  /// The name in code.
  std::string_view name;
  /// `true` for a final state.
  bool is_final = false;
  /// `true` for a failure.
  bool is_error = false;
};

/// The values of an enum. The generated code specializes it.
template <class T>
struct Values;

namespace detail {

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

template <class T>
struct IsList : std::false_type {};
template <class T>
struct IsList<std::vector<T>> : std::true_type {};

template <class T>
struct IsChoice : std::false_type {};
template <class... Ts>
struct IsChoice<std::variant<Ts...>> : std::true_type {};

/// Detects an enum that is sent as a string: a class with a nested enum `Value`.
template <class T, class = void>
struct IsTextEnum : std::false_type {};
template <class T>
struct IsTextEnum<T, std::enable_if_t<std::is_enum_v<typename T::Value>>> : std::true_type {};

template <class T>
constexpr bool is_enum = std::is_enum_v<T> || IsTextEnum<T>::value;

template <class T>
constexpr bool is_number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

// ---- reading ----

bool read_quoted_text(Reader& reader, std::string& out, std::string_view wanted);
bool read_zero_or_one(Reader& reader, bool& out);
bool read_bool(Reader& reader, const Field& field, bool& out);
/// Reads the string of a quoted number. `out` is ready to be parsed; `0x` is converted to decimal.
bool read_number_text(Reader& reader, const Field& field, std::string& out, std::size_t& start);
[[nodiscard]] std::size_t characters(std::string_view text);
[[nodiscard]] bool matches(std::string_view text, std::string_view pattern);

template <class T>
bool read_plain_number(Reader& reader, T& out) {
  if constexpr (std::is_same_v<T, double>) {
    return reader.float64(out);
  } else if constexpr (std::is_same_v<T, float>) {
    return reader.float32(out);
  } else {
    return reader.integer(out);
  }
}

template <class T>
bool read_number(Reader& reader, const Field& field, T& out) {
  const bool is_string = reader.peek() == '"';
  if (!is_string && (!field.is_quoted() || field.is_lenient_number())) {
    return read_plain_number(reader, out);
  }
  std::string text;
  std::size_t start = 0;
  if (!is_string || !(field.is_quoted() || field.is_lenient_number())) {
    if (field.is_quoted()) return reader.unexpected("a number as a string");
    return read_plain_number(reader, out);
  }
  if (!read_number_text(reader, field, text, start)) return false;
  Reader inside(text, Allowance{0, 0, 0});
  const bool is_read = read_plain_number(inside, out);
  const bool is_whole = inside.offset() == text.size();
  if (is_read && is_whole) return true;
  const bool beyond = !is_read && is_whole && inside.error().kind == BodyErrorKind::OutOfRange;
  return reader.fail(beyond ? BodyErrorKind::OutOfRange : BodyErrorKind::WrongType, start,
                     "the string does not hold such a number");
}

template <class T>
bool read_value(Reader& reader, const Field& field, T& out);

template <class T>
bool read_list(Reader& reader, const Field& field, std::vector<T>& out) {
  if (!reader.begin_list()) return false;
  out.clear();
  if (reader.end_list()) return true;
  bool more = true;
  while (more) {
    if (out.size() == out.capacity()) {
      const std::size_t room = out.empty() ? 4 : out.size() * 2;
      if (!reader.pay((room - out.size()) * sizeof(T))) return false;
      out.reserve(room);
    }
    if (!reader.count(1)) return false;
    T item{};
    if (!read_value(reader, field, item)) return reader.in_item(out.size());
    out.push_back(std::move(item));
    if (!reader.next_item(more)) return false;
  }
  return true;
}

/// Finds the first variant whose required keys are all in the next object. Does not consume the
/// object.
bool choose(Reader& reader, const std::vector<RequiredKeys>& variants, std::size_t& chosen);

template <class Choice, std::size_t... I>
bool read_choice(Reader& reader, Choice& out, std::index_sequence<I...> /*indices*/) {
  std::vector<RequiredKeys> variants(sizeof...(I));
  (Codec<std::variant_alternative_t<I, Choice>>::required(variants[I]), ...);
  std::size_t chosen = 0;
  if (!choose(reader, variants, chosen)) return false;
  bool is_read = false;
  const auto read_as = [&](auto index) {
    using Variant = std::variant_alternative_t<decltype(index)::value, Choice>;
    if (chosen != decltype(index)::value) return;
    is_read = Codec<Variant>::read(reader, out.template emplace<decltype(index)::value>());
  };
  (read_as(std::integral_constant<std::size_t, I>{}), ...);
  return is_read;
}

template <class T>
bool read_value(Reader& reader, const Field& field, T& out) {
  if constexpr (IsRequired<T>::value) {
    return read_value(reader, field, out.emplace());
  } else if constexpr (IsOptional<T>::value) {
    out.reset();
    if (field.is_empty_absent() ? reader.take_empty() : reader.take_null()) return true;
    return read_value(reader, field, out.emplace());
  } else if constexpr (std::is_same_v<T, bool>) {
    return read_bool(reader, field, out);
  } else if constexpr (is_number<T>) {
    return read_number(reader, field, out);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return reader.string(out);
  } else if constexpr (std::is_same_v<T, Json>) {
    return reader.json(out);
  } else if constexpr (std::is_same_v<T, Bytes>) {
    if (!field.is_base64()) return read_list(reader, field, out);
    std::string bytes;
    if (!reader.base64(bytes)) return false;
    out.assign(bytes.begin(), bytes.end());
    return true;
  } else if constexpr (IsList<T>::value) {
    return read_list(reader, field, out);
  } else if constexpr (IsChoice<T>::value) {
    return read_choice(reader, out, std::make_index_sequence<std::variant_size_v<T>>{});
  } else if constexpr (is_enum<T>) {
    return EnumCodec<T>::read(reader, field, out);
  } else if constexpr (is_id<T>) {
    typename T::Held value{};
    if (!read_value(reader, field, value)) return false;
    out = T(std::move(value));
    return true;
  } else {
    return Codec<T>::read(reader, out);
  }
}

// ---- constraints ----

/// The reason why a value breaks a constraint of its field.
struct Breach {
  BodyErrorKind kind = BodyErrorKind::OutOfRange;
  std::string_view detail;
};

template <class T>
bool keeps_items(const Field& field, const T& value, Breach& breach);

/// Returns `true` if a value satisfies the constraints of its field. An absent value does.
template <class T>
bool keeps(const Field& field, const T& value, Breach& breach) {
  if constexpr (IsRequired<T>::value) {
    return keeps(field, value.value(), breach);
  } else if constexpr (is_id<T>) {
    return keeps(field, value.value(), breach);
  } else if constexpr (IsOptional<T>::value) {
    return !value.has_value() || keeps(field, *value, breach);
  } else {
    if (field.has_length()) {
      std::size_t length = 0;
      if constexpr (std::is_same_v<T, std::string>) length = characters(value);
      if constexpr (IsList<T>::value) length = value.size();
      if (!field.takes_length(length)) {
        breach = {BodyErrorKind::BadLength, "the length is outside of what is allowed"};
        return false;
      }
    }
    return keeps_items(field, value, breach);
  }
}

template <class T>
bool keeps_items(const Field& field, const T& value, Breach& breach) {
  if constexpr (is_id<T>) {
    return keeps_items(field, value.value(), breach);
  } else if constexpr (IsList<T>::value) {
    if constexpr (std::is_same_v<T, Bytes>) {
      if (field.is_base64()) return true;
    }
    for (const auto& item : value) {
      if (!keeps_items(field, static_cast<const typename T::value_type&>(item), breach))
        return false;
    }
  } else if constexpr (is_number<T>) {
    breach = {BodyErrorKind::OutOfRange, field.number_fault(value)};
    return breach.detail.empty();
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!field.pattern_source().empty() && !matches(value, field.pattern_source())) {
      breach = {BodyErrorKind::BadPattern, "the string does not match its pattern"};
      return false;
    }
  } else if constexpr (std::is_enum_v<T>) {
    if (field.has_only() && !field.takes(static_cast<std::int64_t>(value))) {
      breach = {BodyErrorKind::OutOfRange, "the field does not take this value"};
      return false;
    }
  } else if constexpr (IsTextEnum<T>::value) {
    if (field.has_only() && !field.takes(std::string_view(value.wire()))) {
      breach = {BodyErrorKind::OutOfRange, "the field does not take this value"};
      return false;
    }
  }
  return true;
}

}  // namespace detail

}  // namespace fc_runtime
