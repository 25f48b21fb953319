// Functions for any message or enum of a protocol.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fc_runtime/error.hpp"
#include "fc_runtime/json.hpp"
#include "fc_runtime/required.hpp"
#include "fc_runtime/result.hpp"

namespace fc_runtime {

class Field;
class Reader;
class Writer;

/// The keys of each required field, the main key first.
using RequiredKeys = std::vector<std::vector<std::string_view>>;

/// Reads additional keys in the object of a message, such as those of an envelope.
class Beside {
 public:
  Beside() = default;
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  virtual ~Beside() = default;
  /// Reads the value if the key is one of the additional ones. `taken` returns `true` then.
  [[nodiscard]] virtual bool read(std::string_view key, Reader& reader, bool& taken) = 0;
};

/// A conditional field that is missing, or present although its condition does not hold.
struct ConditionError {
  /// The wire path of the field, such as `data[0].itemInfo`.
  std::string path;
  /// `true` for a missing field, `false` for a superfluous one.
  bool is_missing = false;
  /// The condition of the field, such as "when `stationType` is 6".
  std::string condition;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const ConditionError& error);

/// Reads and writes a type. Generated code instantiates it once per type; users do not call it.
template <class T>
struct Codec {
  static bool read(Reader& reader, T& out);
  static bool read_beside(Reader& reader, T& out, Beside* beside);
  static void write(Writer& writer, const T& value);
  static void write_members(Writer& writer, const T& value, bool first);
  static bool equal(const T& left, const T& right);
  static void print(std::ostream& out, const T& value);
  static std::optional<ConditionError> conditions(const T& value);
  static void required(RequiredKeys& keys);
  static std::string_view name();
  static std::string_view example();
};

/// Reads and writes an enum. Instantiated once per enum, like `Codec`.
template <class T>
struct EnumCodec {
  static bool read(Reader& reader, const Field& field, T& out);
  static void write(Writer& writer, const Field& field, const T& value);
  static void print(std::ostream& out, const T& value);
};

/// Reads a message from JSON.
template <class T>
Result<T, BodyError> from_json(std::string_view text, const Allowance& allowance = {});

/// Writes a message as JSON, if it satisfies its constraints.
template <class T>
Result<std::string, BodyError> to_json(const T& message);

/// Returns the example of a message in the spec.
template <class T>
[[nodiscard]] T example();

/// Checks that each conditional field is present exactly if its condition holds. The runtime does
/// not check this in received messages. Use it for messages that you create.
template <class T>
[[nodiscard]] std::optional<ConditionError> check_conditions(const T& message) {
  return Codec<T>::conditions(message);
}

namespace detail {

using ReadInto = bool (*)(Reader&, void*, Beside*);

/// Reads a complete text: UTF-8 and exactly one object. Invalid JSON takes precedence over all
/// other errors.
[[nodiscard]] bool read_object(std::string_view text, const Allowance& allowance, ReadInto read,
                               void* out, Beside* beside, BodyError& error);

using WriteFrom = void (*)(Writer&, const void*);

[[nodiscard]] bool write_object(const void* message, WriteFrom write, std::string& out,
                                BodyError& error);

template <class T>
bool read_into(Reader& reader, void* out, Beside* beside) {
  return Codec<T>::read_beside(reader, *static_cast<T*>(out), beside);
}

template <class T>
void write_from(Writer& writer, const void* message) {
  Codec<T>::write(writer, *static_cast<const T*>(message));
}

}  // namespace detail

template <class T>
Result<T, BodyError> from_json(std::string_view text, const Allowance& allowance) {
  T message;
  BodyError error;
  if (!detail::read_object(text, allowance, detail::read_into<T>, &message, nullptr, error)) {
    return error;
  }
  return message;
}

template <class T>
Result<std::string, BodyError> to_json(const T& message) {
  std::string text;
  BodyError error;
  if (!detail::write_object(&message, detail::write_from<T>, text, error)) return error;
  return text;
}

template <class T>
T example() {
  return from_json<T>(Codec<T>::example()).value_or(T());
}

/// A type of a protocol as data, for code that handles messages of any type.
struct TypeInfo {
  /// Its name in the spec.
  std::string_view name;
  /// The example in the spec, as JSON.
  std::string_view example;
  /// Reads a text as the type, with additional keys, and writes it again.
  Result<std::string, BodyError> (*transcode)(std::string_view text, const Allowance& allowance,
                                              Beside* beside);
  /// Reads a text as the type and returns the error, if any.
  std::optional<BodyError> (*check)(std::string_view text, const Allowance& allowance,
                                    Beside* beside);
};

namespace detail {

template <class T>
Result<std::string, BodyError> transcode(std::string_view text, const Allowance& allowance,
                                         Beside* beside) {
  T message;
  BodyError error;
  if (!read_object(text, allowance, read_into<T>, &message, beside, error)) return error;
  return to_json(message);
}

template <class T>
std::optional<BodyError> check(std::string_view text, const Allowance& allowance, Beside* beside) {
  T message;
  BodyError error;
  if (read_object(text, allowance, read_into<T>, &message, beside, error)) return std::nullopt;
  return error;
}

}  // namespace detail

/// Returns a type as data.
template <class T>
[[nodiscard]] TypeInfo type_info() {
  return {Codec<T>::name(), Codec<T>::example(), detail::transcode<T>, detail::check<T>};
}

}  // namespace fc_runtime
