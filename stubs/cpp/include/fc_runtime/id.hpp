// Ids of entities, with one type per entity.
#pragma once

#include <cstddef>
#include <functional>
#include <ostream>
#include <type_traits>
#include <utility>

namespace fc_runtime {

namespace detail {

/// The base of all ids.
struct AnyId {};

template <class T>
constexpr bool is_id = std::is_base_of_v<AnyId, T>;

}  // namespace detail

/// The id of an entity. `Self` derives from it. The compiler keeps the ids of different entities
/// apart. An id is sent as the value in it.
template <class Self, class Value>
class Id : detail::AnyId {
 public:
  /// The type of the value: a string or an integer.
  using Held = Value;

  /// The id with the value `Value()`.
  Id() = default;
  explicit Id(Value value) : value_(std::move(value)) {}

  /// The value.
  [[nodiscard]] const Value& value() const noexcept { return value_; }

  friend bool operator==(const Self& left, const Self& right) {
    return left.value() == right.value();
  }
  friend bool operator!=(const Self& left, const Self& right) { return !(left == right); }
  friend bool operator<(const Self& left, const Self& right) {
    return left.value() < right.value();
  }
  friend std::ostream& operator<<(std::ostream& out, const Self& id) {
    if constexpr (std::is_integral_v<Value>) {
      return out << +id.value();
    } else {
      return out << id.value();
    }
  }

 private:
  Value value_{};
};

/// The hash of an id, for the unordered containers of the standard library.
struct HashOfId {
  template <class T>
  std::size_t operator()(const T& id) const {
    return std::hash<typename T::Held>()(id.value());
  }
};

}  // namespace fc_runtime
