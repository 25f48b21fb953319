// Visitors that read, write, compare and print the fields of any message. Only generated .cpp files
// include this header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "fc_runtime/condition.hpp"
#include "fc_runtime/field.hpp"
#include "fc_runtime/message.hpp"
#include "fc_runtime/reader.hpp"
#include "fc_runtime/required.hpp"
#include "fc_runtime/value.hpp"
#include "fc_runtime/writer.hpp"

namespace fc_runtime {

namespace detail {

// ---- visitors of fields ----

/// The offset of each received value, by the index of its field in the message. 0: not received.
using Places = std::vector<std::size_t>;

/// Reads the value of one key into its field.
class ReadKey {
 public:
  ReadKey(Reader& reader, std::string_view key, Places& places)
      : reader_(reader), key_(key), places_(places) {}

  template <class T>
  void operator()(const Field& field, T& member) {
    const std::size_t index = index_++;
    if (taken_ || !field.is_called(key_)) return;
    taken_ = true;
    const std::string_view name = field.name_of(key_);
    good_ = read(field, index, member);
    if (!good_) reader_.in_key(name);
  }

  [[nodiscard]] bool taken() const { return taken_; }
  [[nodiscard]] bool good() const { return good_; }

 private:
  template <class T>
  bool read(const Field& field, std::size_t index, T& member) {
    if (places_.size() <= index) places_.resize(index + 1);
    reader_.peek();
    const std::size_t start = reader_.offset();
    if (places_[index] != 0) {
      return reader_.fail(BodyErrorKind::DuplicateKey, start, "the key came before; send it once");
    }
    places_[index] = start;
    return reader_.count(1) && read_value(reader_, field, member);
  }

  Reader& reader_;
  std::string_view key_;
  Places& places_;
  std::size_t index_ = 0;
  bool taken_ = false;
  bool good_ = true;
};

/// Finds the first missing required field.
class FindMissing {
 public:
  explicit FindMissing(const Places& places) : places_(places) {}

  template <class T>
  void operator()(const Field& field, const T& /*member*/) {
    const std::size_t index = index_++;
    if (IsOptional<T>::value || !missing_.empty()) return;
    if (index >= places_.size() || places_[index] == 0) missing_ = field.key();
  }

  [[nodiscard]] std::string_view missing() const { return missing_; }

 private:
  const Places& places_;
  std::size_t index_ = 0;
  std::string_view missing_;
};

/// Finds the first field that breaks one of its constraints. Runs after all fields are read.
class FindBreach {
 public:
  FindBreach(Reader& reader, const Places& places) : reader_(reader), places_(places) {}

  template <class T>
  void operator()(const Field& field, const T& member) {
    const std::size_t index = index_++;
    Breach breach;
    if (!good_ || keeps(field, member, breach)) return;
    good_ = false;
    reader_.fail(breach.kind, index < places_.size() ? places_[index] : 0, breach.detail);
    reader_.in_key(field.key());
  }

  [[nodiscard]] bool good() const { return good_; }

 private:
  Reader& reader_;
  const Places& places_;
  std::size_t index_ = 0;
  bool good_ = true;
};

/// Collects the keys of the required fields.
class CollectRequired {
 public:
  explicit CollectRequired(RequiredKeys& keys) : keys_(keys) {}

  template <class T>
  void operator()(const Field& field, const T& /*member*/) {
    if (IsOptional<T>::value) return;
    auto& names = keys_.emplace_back();
    names.push_back(field.key());
    for (std::size_t index = 0; index < field.also_count(); ++index) {
      names.push_back(field.also_at(index));
    }
  }

 private:
  RequiredKeys& keys_;
};

// ---- writing ----

template <class T>
void write_value(Writer& writer, const Field& field, const T& value) {
  if constexpr (IsRequired<T>::value) {
    write_value(writer, field, value.value());
  } else if constexpr (IsOptional<T>::value) {
    write_value(writer, field, *value);
  } else if constexpr (std::is_same_v<T, bool>) {
    if (field.is_numeric()) {
      writer.raw(value ? '1' : '0');
    } else {
      if (field.is_quoted()) writer.raw('"');
      writer.boolean(value);
      if (field.is_quoted()) writer.raw('"');
    }
  } else if constexpr (is_number<T>) {
    if (field.is_quoted()) writer.raw('"');
    if constexpr (std::is_same_v<T, double>) {
      writer.float64(value);
    } else if constexpr (std::is_same_v<T, float>) {
      writer.float32(value);
    } else {
      writer.integer(value);
    }
    if (field.is_quoted()) writer.raw('"');
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!is_utf8(value)) writer.fail(BodyErrorKind::NotUtf8, "the text is not UTF-8");
    writer.string(value);
  } else if constexpr (std::is_same_v<T, Json>) {
    writer.json(value);
  } else if constexpr (IsList<T>::value) {
    if constexpr (std::is_same_v<T, Bytes>) {
      if (field.is_base64()) {
        writer.base64({reinterpret_cast<const char*>(value.data()), value.size()});
        return;
      }
    }
    writer.raw('[');
    std::size_t index = 0;
    for (const auto& item : value) {
      if (index > 0) writer.raw(',');
      const bool had_failed = writer.has_failed();
      write_value(writer, field, static_cast<const typename T::value_type&>(item));
      if (!had_failed && writer.has_failed()) writer.in_item(index);
      ++index;
    }
    writer.raw(']');
  } else if constexpr (IsChoice<T>::value) {
    std::visit(
        [&writer](const auto& variant) {
          Codec<std::decay_t<decltype(variant)>>::write(writer, variant);
        },
        value);
  } else if constexpr (is_enum<T>) {
    EnumCodec<T>::write(writer, field, value);
  } else if constexpr (is_id<T>) {
    write_value(writer, field, value.value());
  } else {
    Codec<T>::write(writer, value);
  }
}

/// Writes each present field.
class WriteMembers {
 public:
  WriteMembers(Writer& writer, bool first) : writer_(writer), first_(first) {}

  template <class T>
  void operator()(const Field& field, const T& member) {
    if constexpr (IsOptional<T>::value) {
      if (!member.has_value()) return;
    }
    if (!first_) writer_.raw(',');
    first_ = false;
    writer_.raw('"');
    writer_.raw(field.key());
    writer_.raw("\":");
    const bool had_failed = writer_.has_failed();
    if constexpr (IsRequired<T>::value) {
      if (!member.is_set())
        writer_.fail(BodyErrorKind::MissingField, "the key is required; set it");
    }
    Breach breach;
    if (!keeps(field, member, breach)) writer_.fail(breach.kind, breach.detail);
    write_value(writer_, field, member);
    if (!had_failed && writer_.has_failed()) writer_.in_key(field.key());
  }

  [[nodiscard]] bool first() const { return first_; }

 private:
  Writer& writer_;
  bool first_;
};

// ---- comparing ----

/// Collects the addresses of the members of one message.
class CollectMembers {
 public:
  explicit CollectMembers(std::vector<const void*>& members) : members_(members) {}

  template <class T>
  void operator()(const Field& /*field*/, const T& member) {
    members_.push_back(&member);
  }

 private:
  std::vector<const void*>& members_;
};

/// Compares the collected members with those of another message of the same type.
class CompareMembers {
 public:
  explicit CompareMembers(const std::vector<const void*>& members) : members_(members) {}

  template <class T>
  void operator()(const Field& /*field*/, const T& member) {
    const T& other = *static_cast<const T*>(members_[index_]);
    ++index_;
    if constexpr (IsRequired<T>::value) {
      equal_ = equal_ && other.is_set() == member.is_set() && other.value() == member.value();
    } else {
      equal_ = equal_ && other == member;
    }
  }

  [[nodiscard]] bool equal() const { return equal_; }

 private:
  const std::vector<const void*>& members_;
  std::size_t index_ = 0;
  bool equal_ = true;
};

// ---- printing ----

template <class T>
void print_value(std::ostream& out, const Field& field, const T& value) {
  if constexpr (IsRequired<T>::value) {
    if (value.is_set()) {
      print_value(out, field, value.value());
    } else {
      out << "(unset)";
    }
  } else if constexpr (IsOptional<T>::value) {
    print_value(out, field, *value);
  } else if constexpr (std::is_same_v<T, bool>) {
    out << (value ? "true" : "false");
  } else if constexpr (std::is_integral_v<T>) {
    out << +value;
  } else if constexpr (std::is_floating_point_v<T>) {
    out << float_text(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    out << '"' << value << '"';
  } else if constexpr (IsList<T>::value) {
    if constexpr (std::is_same_v<T, Bytes>) {
      if (field.is_base64()) {
        out << value.size() << " bytes";
        return;
      }
    }
    out << '[';
    bool first = true;
    for (const auto& item : value) {
      if (!first) out << ", ";
      first = false;
      print_value(out, field, static_cast<const typename T::value_type&>(item));
    }
    out << ']';
  } else if constexpr (IsChoice<T>::value) {
    std::visit([&](const auto& variant) { print_value(out, field, variant); }, value);
  } else if constexpr (std::is_same_v<T, Json>) {
    out << value;
  } else if constexpr (is_enum<T>) {
    out << value;
  } else if constexpr (is_id<T>) {
    print_value(out, field, value.value());
  } else {
    Codec<T>::print(out, value);
  }
}

/// Prints each present field, and masks the values of sensitive ones.
class PrintMembers {
 public:
  explicit PrintMembers(std::ostream& out) : out_(out) {}

  template <class T>
  void operator()(const Field& field, const T& member) {
    if constexpr (IsOptional<T>::value) {
      if (!member.has_value()) return;
    }
    out_ << (first_ ? "{" : ", ") << field.key() << ": ";
    first_ = false;
    if (field.is_sensitive()) {
      out_ << "***";
    } else {
      print_value(out_, field, member);
    }
  }

  void end(std::size_t others) {
    if (others > 0) {
      out_ << (first_ ? "{" : ", ") << "+" << others;
      first_ = false;
    }
    out_ << (first_ ? "{}" : "}");
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

}  // namespace detail

// ---- messages ----

template <class T>
bool Codec<T>::read_beside(Reader& reader, T& out, Beside* beside) {
  reader.peek();
  const std::size_t start = reader.offset();
  if (!reader.begin_object()) return false;
  detail::Places places;
  while (!reader.end_object()) {
    std::string_view key;
    if (!reader.key(key)) return false;
    bool taken = false;
    if (beside != nullptr && !beside->read(key, reader, taken)) return false;
    if (!taken) {
      detail::ReadKey visit(reader, key, places);
      Fields<T>::each(visit, out);
      if (!visit.good()) return false;
      if (!visit.taken() && (!reader.count(1) || !reader.keep(out.extra))) return false;
    }
    if (!reader.end_value()) return false;
  }
  detail::FindMissing find(places);
  Fields<T>::each(find, static_cast<const T&>(out));
  if (!find.missing().empty()) {
    reader.fail(BodyErrorKind::MissingField, start, "the key is required; send it");
    return reader.in_key(find.missing());
  }
  detail::FindBreach held(reader, places);
  Fields<T>::each(held, static_cast<const T&>(out));
  return held.good();
}

template <class T>
bool Codec<T>::read(Reader& reader, T& out) {
  return read_beside(reader, out, nullptr);
}

template <class T>
bool Codec<T>::equal(const T& left, const T& right) {
  std::vector<const void*> members;
  detail::CollectMembers collect(members);
  Fields<T>::each(collect, left);
  detail::CompareMembers compare(members);
  Fields<T>::each(compare, right);
  return compare.equal() && left.extra == right.extra;
}

template <class T>
void Codec<T>::write_members(Writer& writer, const T& value, bool first) {
  detail::WriteMembers visit(writer, first);
  Fields<T>::each(visit, value);
  writer.extra(value.extra, visit.first());
}

template <class T>
void Codec<T>::write(Writer& writer, const T& value) {
  writer.raw('{');
  write_members(writer, value, true);
  writer.raw('}');
}

template <class T>
void Codec<T>::print(std::ostream& out, const T& value) {
  out << name();
  detail::PrintMembers visit(out);
  Fields<T>::each(visit, value);
  visit.end(value.extra.size());
}

template <class T>
std::optional<ConditionError> Codec<T>::conditions(const T& value) {
  Conditions visit;
  Fields<T>::each(visit, value);
  Fields<T>::conditions(visit, value);
  return std::move(visit).found();
}

template <class T>
void Codec<T>::required(RequiredKeys& keys) {
  detail::CollectRequired visit(keys);
  const T message{};
  Fields<T>::each(visit, message);
}

template <class T>
std::string_view Codec<T>::name() {
  return Fields<T>::name;
}

template <class T>
std::string_view Codec<T>::example() {
  return Fields<T>::example;
}

// ---- enums ----

template <class T>
bool EnumCodec<T>::read(Reader& reader, const Field& field, T& out) {
  reader.peek();
  const std::size_t start = reader.offset();
  if constexpr (std::is_enum_v<T>) {
    std::underlying_type_t<T> wire{};
    if (!detail::read_number(reader, field, wire)) return false;
    out = static_cast<T>(wire);
  } else {
    std::string_view wire;
    if (!reader.text(wire)) return false;
    out = T(std::string(wire));
  }
  if constexpr (Values<T>::closed) {
    if (!is_known(out)) {
      return reader.fail(BodyErrorKind::UnknownValue, start, "none of the values of this field");
    }
  }
  return true;
}

template <class T>
void EnumCodec<T>::write(Writer& writer, const Field& field, const T& value) {
  if constexpr (Values<T>::closed) {
    if (!is_known(value))
      writer.fail(BodyErrorKind::UnknownValue, "none of the values of this field");
  }
  if constexpr (std::is_enum_v<T>) {
    detail::write_value(writer, field, static_cast<std::underlying_type_t<T>>(value));
  } else {
    detail::write_value(writer, field, std::string(value.wire()));
  }
}

namespace detail {

/// Returns the entry of a known value, or null for an unknown one.
template <class T>
const auto* find_value(const T& value) noexcept {
  const auto& all = Values<T>::all;
  for (const auto& known : all) {
    if constexpr (std::is_enum_v<T>) {
      if (known.wire == value) return &known;
    } else {
      if (known.wire == value.wire()) return &known;
    }
  }
  return static_cast<decltype(&all[0])>(nullptr);
}

}  // namespace detail

template <class T>
void EnumCodec<T>::print(std::ostream& out, const T& value) {
  const auto* known = detail::find_value(value);
  if (known != nullptr) {
    out << known->name;
  } else if constexpr (std::is_enum_v<T>) {
    out << "Unknown(" << +static_cast<std::underlying_type_t<T>>(value) << ")";
  } else {
    out << "Unknown(\"" << value.wire() << "\")";
  }
}

}  // namespace fc_runtime
