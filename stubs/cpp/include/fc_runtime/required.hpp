// Required fields of messages.
#pragma once

#include <type_traits>
#include <utility>

namespace fc_runtime {

/// A required field of type `T`: a number, a bool, an enum, a string, bytes or JSON. It starts
/// unset. Writing a message with an unset field fails with `missing_field`.
///
/// Assign a `T`, and use it like a `T`. In a template or `?:`, use its `value()`.
template <class T, bool = std::is_class_v<T>>
class Required;

/// A number, a bool, or an enum that is sent as a number.
template <class T>
class Required<T, false> {
 public:
  /// Unset.
  constexpr Required() noexcept = default;
  // NOLINTBEGIN(google-explicit-constructor): it is used like a `T`
  /// Set to a value.
  constexpr Required(T value) noexcept : value_(value), is_set_(true) {}
  constexpr operator T() const noexcept { return value_; }
  // NOLINTEND(google-explicit-constructor)
  constexpr Required& operator=(T value) noexcept {
    value_ = value;
    is_set_ = true;
    return *this;
  }

  /// Returns `true` once the field has a value.
  [[nodiscard]] constexpr bool is_set() const noexcept { return is_set_; }
  /// The value; `T()` while it is unset.
  [[nodiscard]] constexpr const T& value() const noexcept { return value_; }
  /// Sets the field to `T()` and returns it for changes.
  T& emplace() noexcept {
    *this = T();
    return value_;
  }

 private:
  T value_ = T();
  bool is_set_ = false;
};

/// A string, bytes, JSON, or an enum that is sent as a string. It derives from `T` and has its
/// members.
template <class T>
class Required<T, true> : public T {
  template <class U>
  using IfOther = std::enable_if_t<!std::is_base_of_v<Required, std::decay_t<U>>>;

 public:
  /// Unset.
  Required() = default;
  /// Set to a value.
  // NOLINTNEXTLINE(google-explicit-constructor): it is used like a `T`
  template <class U = T, class = IfOther<U>, class = std::enable_if_t<std::is_convertible_v<U, T>>>
  Required(U&& value) : T(std::forward<U>(value)), is_set_(true) {}
  template <class U = T, class = IfOther<U>, class = std::enable_if_t<std::is_assignable_v<T&, U>>>
  Required& operator=(U&& value) {
    static_cast<T&>(*this) = std::forward<U>(value);
    is_set_ = true;
    return *this;
  }

  /// Returns `true` once the field has a value, by assignment or by a member of `T`.
  [[nodiscard]] bool is_set() const { return is_set_ || !(value() == T()); }
  /// The value; `T()` while it is unset.
  [[nodiscard]] const T& value() const noexcept { return *this; }
  /// Sets the field to `T()` and returns it for changes.
  T& emplace() { return *this = T(); }

 private:
  bool is_set_ = false;
};

namespace detail {

template <class T>
struct IsRequired : std::false_type {};
template <class T>
struct IsRequired<Required<T>> : std::true_type {};

}  // namespace detail

}  // namespace fc_runtime
