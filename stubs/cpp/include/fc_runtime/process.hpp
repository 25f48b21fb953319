// Access to fields inside messages; for generated code.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>

#include "fc_runtime/operation.hpp"
#include "fc_runtime/required.hpp"

namespace fc_runtime::detail {

/// Returns a member of `holder`, or null if the holder or the member is absent.
template <class Holder, class Member>
const Member* at(const Holder* holder, Member Holder::*member) {
  return holder == nullptr ? nullptr : &(holder->*member);
}
template <class Holder, class Member>
const Member* at(const Holder* holder, Required<Member> Holder::*member) {
  return holder == nullptr ? nullptr : &(holder->*member).value();
}
template <class Holder, class Member>
const Member* at(const Holder* holder, std::optional<Member> Holder::*member) {
  if (holder == nullptr || !(holder->*member).has_value()) return nullptr;
  return &*(holder->*member);
}

/// Returns `true` unless both values are present and differ.
template <class Left, class Right>
bool may_be_same(const Left* left, const Right* right) {
  if (left == nullptr || right == nullptr) return true;
  if constexpr (std::is_integral_v<Left> && std::is_integral_v<Right>) {
    return static_cast<std::int64_t>(*left) == static_cast<std::int64_t>(*right);
  } else {
    return *left == *right;
  }
}

/// Returns `true` if a value is present and passes a test.
template <class Value, class Test>
bool holds(const Value* value, const Test& test) {
  return value != nullptr && test(*value);
}

}  // namespace fc_runtime::detail
