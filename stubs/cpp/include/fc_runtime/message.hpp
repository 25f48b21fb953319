// What can be done with any message or enum of a protocol.
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

/// The keys of a required field, its own first.
using RequiredKeys = std::vector<std::vector<std::string_view>>;

/// Reads keys that are next to a message's own in the same object, as those of an envelope.
class Beside {
 public:
  Beside() = default;
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  virtual ~Beside() = default;
  /// Reads the value of a key that is its own, and says in `taken` whether it is.
  [[nodiscard]] virtual bool read(std::string_view key, Reader& reader, bool& taken) = 0;
};

/// A message whose field contradicts the condition under which it is there.
struct ConditionError {
  /// The wire keys down to the field, such as `data[0].itemInfo`.
  std::string path;
  /// Whether it is missing, or there without being asked for.
  bool is_missing = false;
  /// When it is sent, such as "when `stationType` is 6".
  std::string condition;
};

/// The error as one line.
[[nodiscard]] std::string to_string(const ConditionError& error);

/// How a type is read and written. Its functions are compiled once for each type, beside the fields
/// that the type names; nobody needs to call them by hand.
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

/// How an enum is read and written; as `Codec`, compiled once for each.
template <class T>
struct EnumCodec {
  static bool read(Reader& reader, const Field& field, T& out);
  static void write(Writer& writer, const Field& field, const T& value);
  static void print(std::ostream& out, const T& value);
};

/// Reads a text as a message.
template <class T>
Result<T, BodyError> from_json(std::string_view text, const Allowance& allowance = {});

/// Writes a message as a text, if it keeps its own constraints.
template <class T>
Result<std::string, BodyError> to_json(const T& message);

/// The spec's example of a message.
template <class T>
[[nodiscard]] T example();

/// Whether each field of a message that is there only under a condition is there exactly then. What a
/// peer sends is taken as it is; ask this of what you make.
template <class T>
[[nodiscard]] std::optional<ConditionError> check_conditions(const T& message) {
  return Codec<T>::conditions(message);
}

namespace detail {

using ReadInto = bool (*)(Reader&, void*, Beside*);

/// Reads a whole text: UTF-8, one object, nothing around it. That it is not JSON goes before all else.
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

/// A type of a protocol as data, for what deals with messages of any type.
struct TypeInfo {
  /// Its name in the spec.
  std::string_view name;
  /// The spec's example of it, as JSON.
  std::string_view example;
  /// Reads a text as the type, with what is next to it, and writes it again.
  Result<std::string, BodyError> (*transcode)(std::string_view text, const Allowance& allowance,
                                              Beside* beside);
  /// Reads a text as the type, and says what is wrong with it.
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

/// A type as data.
template <class T>
[[nodiscard]] TypeInfo type_info() {
  return {Codec<T>::name(), Codec<T>::example(), detail::transcode<T>, detail::check<T>};
}

}  // namespace fc_runtime
