// Ways to fields inside messages; for generated code.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>

#include "fc_runtime/operation.hpp"
#include "fc_runtime/required.hpp"

namespace fc_runtime::detail {

/// A member of what is held; null where that is not there, or the member is absent.
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

/// Whether two values may be the same: what either does not say cannot tell them apart.
template <class Left, class Right>
bool may_be_same(const Left* left, const Right* right) {
  if (left == nullptr || right == nullptr) return true;
  if constexpr (std::is_integral_v<Left> && std::is_integral_v<Right>) {
    return static_cast<std::int64_t>(*left) == static_cast<std::int64_t>(*right);
  } else {
    return *left == *right;
  }
}

/// Whether something is there, and is so.
template <class Value, class Test>
bool holds(const Value* value, const Test& test) {
  return value != nullptr && test(*value);
}

}  // namespace fc_runtime::detail
