// A value or an error, without exceptions.
#pragma once

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace fc_runtime {

/// The value of a success without data: `Result<Done, E>`.
struct Done {};

/// A value or an error. Test it before you access the value: `if (result) use(*result);`.
template <class T, class E>
class [[nodiscard]] Result {
  static_assert(!std::is_same_v<T, E>, "a value and an error have different types");

 public:
  using value_type = T;
  using error_type = E;

  // NOLINTBEGIN(google-explicit-constructor): `return value;` and `return error;` are what it is for
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(E error) : state_(std::in_place_index<1>, std::move(error)) {}
  // NOLINTEND(google-explicit-constructor)

  /// Returns `true` if there is a value.
  [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  /// The value. Aborts if there is none.
  [[nodiscard]] T& operator*() & { return *held(); }
  [[nodiscard]] const T& operator*() const& { return *held(); }
  [[nodiscard]] T&& operator*() && { return std::move(*held()); }
  [[nodiscard]] T* operator->() { return held(); }
  [[nodiscard]] const T* operator->() const { return held(); }

  /// The error. Aborts if there is a value.
  [[nodiscard]] const E& error() const& { return *fault(); }
  [[nodiscard]] E&& error() && { return std::move(*fault()); }

  /// Returns the value, or `other` if there is none.
  [[nodiscard]] T value_or(T other) const& { return has_value() ? **this : std::move(other); }

  /// Returns the value. Without one, throws a `std::runtime_error` with the text of the error.
  T& value_or_throw() & {
    if (!has_value()) throw std::runtime_error(to_string(error()));
    return **this;
  }
  T value_or_throw() && {
    if (!has_value()) throw std::runtime_error(to_string(error()));
    return std::move(**this);
  }

 private:
  T* held() {
    T* value = std::get_if<0>(&state_);
    if (value == nullptr) std::abort();  // the caller did not ask
    return value;
  }
  const T* held() const { return const_cast<Result*>(this)->held(); }
  E* fault() {
    E* error = std::get_if<1>(&state_);
    if (error == nullptr) std::abort();  // the caller did not ask
    return error;
  }
  const E* fault() const { return const_cast<Result*>(this)->fault(); }

  std::variant<T, E> state_;
};

}  // namespace fc_runtime
